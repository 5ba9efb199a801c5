/// \file The commit that the program was built from (cmake/Commit.cmake).
#pragma once

#include <string_view>

namespace touchtrial::app {

/// For instance "f697f373", or "f697f373, modified" if tracked files or sources differ from it.
/// Empty if the tree is neither a readable git repository of its own nor from a source archive.
/// Only displayed, never recorded, so that equal studies have equal bytes in each version.
[[nodiscard]] std::string_view program_commit() noexcept;

}  // namespace touchtrial::app
