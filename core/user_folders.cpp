#include "core/user_folders.hpp"

#include <cstdlib>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

/// \return the variable's value if it is an absolute path, else an empty path
fs::path absolute_path_in(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : fs::path();
}

}  // namespace

fs::path user_config_folder() {
  if (const fs::path config_home = absolute_path_in("XDG_CONFIG_HOME"); !config_home.empty()) {
    return config_home / "touchtrial";
  }
  const fs::path home = absolute_path_in("HOME");
  return home.empty() ? home : home / ".config" / "touchtrial";
}

}  // namespace touchtrial
