#include "core/user_folders.hpp"

#include "support/catch.hpp"

#include <cstdlib>
#include <optional>
#include <string>

namespace touchtrial {
namespace {

/// Sets an environment variable during its lifetime.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* former = std::getenv(name); former != nullptr) former_ = former;
    set(value);
  }
  ~Variable() { set(former_ ? former_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) {
    if (value == nullptr) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, value, 1);
    }
  }

  const char* name_;
  std::optional<std::string> former_;
};

TEST_CASE("the folder of settings is the user's, or empty") {
  const Variable home("HOME", "/somebody");
  const Variable config("XDG_CONFIG_HOME", "/elsewhere");
  CHECK(user_config_folder() == "/elsewhere/touchtrial");
  const Variable relative("XDG_CONFIG_HOME", "here");
  CHECK(user_config_folder() == "/somebody/.config/touchtrial");
  const Variable homeless("HOME", nullptr);
  CHECK(user_config_folder().empty());
}

}  // namespace
}  // namespace touchtrial
