#include "device/platform/dynamic_library.hpp"

#include "core/errors.hpp"

#include <utility>

#include <dlfcn.h>

namespace touchtrial {
namespace {

int load_flags(Unload unload) {
  return RTLD_NOW | RTLD_LOCAL | (unload == Unload::never ? RTLD_NODELETE : 0);
}

/// The linker's reason, without the library's name in front, which our message begins with.
std::string reason_for(const std::string& library) {
  const char* text = dlerror();
  if (text == nullptr) return "no reason given";
  const std::string reason = text;
  return reason.starts_with(library + ": ") ? reason.substr(library.size() + 2) : reason;
}

}  // namespace

DynamicLibrary::DynamicLibrary(const std::filesystem::path& library, Unload unload,
                               std::string remedy)
    : name_(library.string()), remedy_(std::move(remedy)) {
  if (name_.empty()) throw DeviceError("no library is named; " + remedy_);
  handle_ = dlopen(name_.c_str(), load_flags(unload));
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
  void* found = address_if_any(name);
  if (found != nullptr) return found;
  throw DeviceError(one_line(name_ + ": has no function " + name + "; " + remedy_));
}

}  // namespace touchtrial
