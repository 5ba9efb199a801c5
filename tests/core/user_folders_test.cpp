#include "core/user_folders.hpp"

#include "support/catch.hpp"
#include "support/environment.hpp"

namespace touchtrial {
namespace {

TEST_CASE("the folder of settings is the user's, or empty") {
  const EnvironmentVariable home("HOME", "/somebody");
  const EnvironmentVariable config("XDG_CONFIG_HOME", "/elsewhere");
  CHECK(user_config_folder() == "/elsewhere/touchtrial");
  const EnvironmentVariable relative("XDG_CONFIG_HOME", "here");
  CHECK(user_config_folder() == "/somebody/.config/touchtrial");
  const EnvironmentVariable homeless("HOME", nullptr);
  CHECK(user_config_folder().empty());
}

}  // namespace
}  // namespace touchtrial
