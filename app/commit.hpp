/// \file The commit that the program was built from (cmake/Commit.cmake).
#pragma once

#include <string_view>

namespace touchtrial::app {

/// The commit, for instance "f697f373", or "f697f373, modified" if tracked files or sources differ
/// from it.
/// Empty if the tree is not the root of a git repository and not from a source archive.
/// It is displayed but never recorded, so that equal studies have equal bytes in each version.
[[nodiscard]] std::string_view program_commit() noexcept;

}  // namespace touchtrial::app
