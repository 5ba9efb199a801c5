/// \file A shared library that is loaded while the program runs, and the functions in it.
#pragma once

#include <filesystem>
#include <string>

namespace touchtrial::device {

/// What happens to the library when its last owner lets go of it.
enum class Unload {
  when_closed,
  never,  ///< for libraries that break when they are loaded a second time
};

/// A vendor's library, found by the dynamic linker's rules (a bare name along its search path).
/// Symbols stay in the library's own scope. Any thread.
class DynamicLibrary {
 public:
  /// Runs the library's initialisers. All its own references are resolved at once, so that none is
  /// missing later, in the middle of a session.
  /// \param remedy  what to do if it cannot be used; ends every error, no full stop
  /// \throws DeviceError naming the library, the linker's reason and the remedy
  DynamicLibrary(const std::filesystem::path& library, Unload unload, std::string remedy);
  ~DynamicLibrary();
  DynamicLibrary(const DynamicLibrary&) = delete;
  DynamicLibrary& operator=(const DynamicLibrary&) = delete;

  /// \tparam Function  the symbol's type; the linker cannot check it
  /// \throws DeviceError naming library, symbol and remedy if there is none of this name
  template <typename Function>
  [[nodiscard]] Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }
  /// \return null if the library does not have it
  template <typename Function>
  [[nodiscard]] Function* function_if_any(const char* name) const noexcept {
    return reinterpret_cast<Function*>(address_if_any(name));
  }

 private:
  [[nodiscard]] void* address(const char* name) const;
  [[nodiscard]] void* address_if_any(const char* name) const noexcept;

  std::string name_;
  std::string remedy_;
  void* handle_;
};

/// Loads the library in a child process, which ends at once: a truncated or broken one may kill
/// whoever loads it. For a program that does not want to be killed for asking; costs a fork.
/// \throws DeviceError naming library and remedy if the child crashes or hangs for ten seconds; not
///   for what DynamicLibrary itself would throw
void expect_loading_survived(const std::filesystem::path& library, const std::string& remedy);

}  // namespace touchtrial::device
