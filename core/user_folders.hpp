/// \file The folder of this program's user for settings.
#pragma once

#include <filesystem>

namespace touchtrial {

/// touchtrial in $XDG_CONFIG_HOME, else in ~/.config. Thread-safe unless the environment changes.
/// \return empty if neither XDG_CONFIG_HOME nor HOME holds an absolute path
[[nodiscard]] std::filesystem::path user_config_folder();

}  // namespace touchtrial
