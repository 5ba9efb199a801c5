/// \file The folders of this program's user: settings, and what need not be found out again.
#pragma once

#include <filesystem>

namespace touchtrial {

/// touchtrial in $XDG_CONFIG_HOME, else in ~/.config. Thread-safe unless the environment changes.
/// \return empty if neither XDG_CONFIG_HOME nor HOME holds an absolute path
[[nodiscard]] std::filesystem::path user_config_folder();

/// touchtrial in $XDG_CACHE_HOME, else in ~/.cache. Thread-safe unless the environment changes.
/// \return empty if neither XDG_CACHE_HOME nor HOME holds an absolute path
[[nodiscard]] std::filesystem::path user_cache_folder();

}  // namespace touchtrial
