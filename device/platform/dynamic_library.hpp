/// \file A shared library loaded at run time, and its functions.
#pragma once

#include <filesystem>
#include <string>

namespace touchtrial::device {

/// What happens to the library when its last owner is destroyed.
enum class Unload {
  when_closed,
  never,  ///< for libraries that break when they are loaded a second time
};

/// When undefined symbols of the library are resolved, and whether its own symbols are global.
enum class Binding {
  /// All at once, so that none is missing during a session; its own symbols are local.
  at_once,
  /// Lazily, with global symbols: for libraries that have unresolved references or plug-ins.
  as_needed,
};

/// A vendor's library, found by the dynamic linker's rules (a bare name along its search path). Any
/// thread may use it.
class DynamicLibrary {
 public:
  /// Runs the library's initialisers.
  /// \param remedy  the last part of every error, without a full stop
  /// \throws DeviceError naming the library, the linker's reason and the remedy
  DynamicLibrary(const std::filesystem::path& library, Unload unload, std::string remedy,
                 Binding binding = Binding::at_once);
  ~DynamicLibrary();
  DynamicLibrary(const DynamicLibrary&) = delete;
  DynamicLibrary& operator=(const DynamicLibrary&) = delete;

  /// \tparam Function  the symbol's type; the linker cannot check it
  /// \throws DeviceError naming library, symbol and remedy if the library does not have it
  template <typename Function>
  [[nodiscard]] Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }
  /// The same, with the type deduced from the pointer.
  template <typename Function>
  void find(const char* name, Function*& pointer) const {
    pointer = function<Function>(name);
  }
  /// \param pointer  null if the library does not have it
  template <typename Function>
  void find_if_any(const char* name, Function*& pointer) const noexcept {
    pointer = reinterpret_cast<Function*>(address_if_any(name));
  }

 private:
  [[nodiscard]] void* address(const char* name) const;
  [[nodiscard]] void* address_if_any(const char* name) const noexcept;

  std::string name_;
  std::string remedy_;
  void* handle_;
};

/// Test-loads the library in a child process, because a truncated or damaged library may crash the
/// process that loads it. Costs a fork.
/// \throws DeviceError naming library and remedy if the child crashes or hangs for ten seconds, but
///   not for errors that DynamicLibrary itself reports
void check_loads(const std::filesystem::path& library, const std::string& remedy,
                 Binding binding = Binding::at_once);

}  // namespace touchtrial::device
