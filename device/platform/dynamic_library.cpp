#include "device/platform/dynamic_library.hpp"

#include "core/errors.hpp"

#include <array>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include <dlfcn.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial::device {
namespace {

int load_flags(Unload unload, Binding binding) {
  return (binding == Binding::at_once ? RTLD_NOW | RTLD_LOCAL : RTLD_LAZY | RTLD_GLOBAL) |
         (unload == Unload::never ? RTLD_NODELETE : 0);
}

/// \return the linker's reason without the library's name, which the error message already contains
std::string reason_for(const std::string& library) {
  const char* text = dlerror();
  if (text == nullptr) return "no reason given";
  const std::string reason = text;
  return reason.starts_with(library + ": ") ? reason.substr(library.size() + 2) : reason;
}

/// Runs in the child process. Crashes are silent, and the parent's exit handlers do not run.
[[noreturn]] void load_and_end(const char* library, Binding binding) {
  for (const int crash : std::array{SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGFPE}) {
    signal(crash, SIG_DFL);
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  dlopen(library, load_flags(Unload::never, binding));
  _exit(0);
}

/// \return the child's status; nothing if it hung and was killed
std::optional<int> status_of(pid_t child) {
  constexpr std::chrono::milliseconds kTimeout{10'000};
  int status = 0;
  for (std::chrono::milliseconds waited(0); waited < kTimeout; ++waited) {
    if (waitpid(child, &status, WNOHANG) == child) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return std::nullopt;
}

}  // namespace

void check_loads(const std::filesystem::path& library, const std::string& remedy, Binding binding) {
  const std::string name = library.string();
  const pid_t child = fork();
  if (child == 0) load_and_end(name.c_str(), binding);
  if (child < 0) return;  // without a test, loading the library itself reports the error
  const std::optional<int> status = status_of(child);
  if (status && !WIFSIGNALED(*status)) return;
  throw DeviceError(one_line(name + (status ? ": crashes" : ": hangs") +
                             " while it is loaded; the file is damaged or for another system; " +
                             remedy));
}

DynamicLibrary::DynamicLibrary(const std::filesystem::path& library, Unload unload,
                               std::string remedy, Binding binding)
    : name_(library.string()), remedy_(std::move(remedy)) {
  if (name_.empty()) throw DeviceError("no library is named; " + remedy_);
  handle_ = dlopen(name_.c_str(), load_flags(unload, binding));
  if (handle_ == nullptr) {
    throw DeviceError(
        one_line(name_ + ": cannot be loaded (" + reason_for(name_) + "); " + remedy_));
  }
}

DynamicLibrary::~DynamicLibrary() {
  dlclose(handle_);
}

void* DynamicLibrary::address_if_any(const char* name) const noexcept {
  return dlsym(handle_, name);
}

void* DynamicLibrary::address(const char* name) const {
  void* symbol = address_if_any(name);
  if (symbol != nullptr) return symbol;
  throw DeviceError(one_line(name_ + ": has no function " + name + "; " + remedy_));
}

}  // namespace touchtrial::device
