#include "engine/fourier/planning.hpp"

#include "engine/fourier/wisdom_files.hpp"

#include <cstdlib>

namespace touchtrial::engine {
namespace {

/// \return the variable's value if that is an absolute path, else nothing
std::filesystem::path absolute_path_in(const char* variable) {
  const char* value = std::getenv(variable);
  const std::filesystem::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

void use_measured_plans(const std::filesystem::path& folder, std::size_t fewest_samples) {
  wisdom_files().set_folder(folder, fewest_samples);
}

std::filesystem::path user_cache_folder() {
  if (const auto cache = absolute_path_in("XDG_CACHE_HOME"); !cache.empty()) {
    return cache / "touchtrial";
  }
  const auto home = absolute_path_in("HOME");
  return home.empty() ? home : home / ".cache" / "touchtrial";
}

}  // namespace touchtrial::engine
