/// \file Sets an environment variable during a test.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include <stdlib.h>

namespace touchtrial {

/// Sets or removes a variable, and restores it on destruction.
class EnvironmentVariable {
 public:
  /// \param value  nullptr: removes the variable
  EnvironmentVariable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
  }
  ~EnvironmentVariable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace touchtrial
