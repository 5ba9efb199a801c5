// Forwards calls of Highway's headers to libhwy.so.1, looked up at the first call. Loading that
// library calibrates a clock, which took a quarter of the program's start-up time. Source:
// hwy/targets.h and hwy/aligned_allocator.h, against which the compiler checks every line, and
// docs/decisions/0047-loaded-when-needed.md.
#include "core/errors.hpp"

#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <dlfcn.h>
#include <hwy/aligned_allocator.h>
#include <hwy/base.h>
#include <hwy/targets.h>

namespace touchtrial::engine {
namespace {

[[noreturn]] void refuse_highway() {
  const char* reason = dlerror();
  throw Error(one_line(std::string("Highway's library cannot be loaded (") +
                       (reason == nullptr ? "libhwy.so.1: no reason given" : reason) +
                       "); install or update libhwy1"));
}

/// Loads Highway's library. It is never unloaded, because scratch memory may outlive all other
/// objects.
void* highway() {
  static void* const handle = [] {
    void* const library = dlopen("libhwy.so.1", RTLD_NOW | RTLD_LOCAL);
    return library != nullptr ? library : (refuse_highway(), nullptr);
  }();
  return handle;
}

/// \param name  mangled name of the function
template <typename Function>
Function* resolve(const char* name) {
  void* const function = dlsym(highway(), name);
  if (function == nullptr) refuse_highway();
  return reinterpret_cast<Function*>(function);
}

}  // namespace
}  // namespace touchtrial::engine

using touchtrial::engine::resolve;

std::int64_t hwy::SupportedTargets() {
  static auto* const function = resolve<decltype(SupportedTargets)>("_ZN3hwy16SupportedTargetsEv");
  return function();
}

hwy::ChosenTarget& hwy::GetChosenTarget() {
  static auto* const function = resolve<decltype(GetChosenTarget)>("_ZN3hwy15GetChosenTargetEv");
  return function();
}

void* hwy::AllocateAlignedBytes(std::size_t payload_size, AllocPtr alloc_ptr, void* opaque_ptr) {
  static auto* const function =
      resolve<decltype(AllocateAlignedBytes)>("_ZN3hwy20AllocateAlignedBytesEmPFPvS0_mES0_");
  return function(payload_size, alloc_ptr, opaque_ptr);
}

void hwy::FreeAlignedBytes(const void* aligned_pointer, FreePtr free_ptr, void* opaque_ptr) {
  static auto* const function =
      resolve<decltype(FreeAlignedBytes)>("_ZN3hwy16FreeAlignedBytesEPKvPFvPvS2_ES2_");
  function(aligned_pointer, free_ptr, opaque_ptr);
}

/// Called by checks in Highway's headers in debug builds. It is not forwarded, so that a bug is
/// reported even without the library.
void hwy::Abort(const char* file, int line, const char* format, ...) {
  std::fprintf(stderr, "Abort at %s:%d: ", file, line);
  std::va_list values;
  va_start(values, format);
  std::vfprintf(stderr, format, values);
  va_end(values);
  std::fputc('\n', stderr);
  std::abort();
}
