/// \file Where exports go.
#pragma once

#include <filesystem>

namespace touchtrial {

/// Makes the folder and those above it. \throws FileError if that is not possible
void make_export_folder(const std::filesystem::path& folder);

}  // namespace touchtrial
