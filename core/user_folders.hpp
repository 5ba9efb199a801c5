/// \file The user's settings folder.
#pragma once

#include <filesystem>

namespace touchtrial {

/// The folder "touchtrial" in $XDG_CONFIG_HOME, or else in ~/.config. Thread-safe unless the
/// environment changes.
/// \return empty if neither XDG_CONFIG_HOME nor HOME contains an absolute path
[[nodiscard]] std::filesystem::path user_config_folder();

}  // namespace touchtrial
