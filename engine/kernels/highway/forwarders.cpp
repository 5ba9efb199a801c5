// The functions of Highway's library, as its headers call them: each but the last looks up the real
// one in libhwy.so.1 at its first call. That library calibrates a clock when it is loaded, which
// took a quarter of the time of the program's start. Source: hwy/targets.h and
// hwy/aligned_allocator.h, against which the compiler checks every line, and
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
  throw Error(one_line(std::string("Highway's library cannot be used (") +
                       (reason == nullptr ? "libhwy.so.1: no reason given" : reason) +
                       "); install or update libhwy1"));
}

/// Never unloaded: rows of scratch memory may outlive everything else.
void* highway() {
  static void* const handle = [] {
    void* const loaded = dlopen("libhwy.so.1", RTLD_NOW | RTLD_LOCAL);
    return loaded != nullptr ? loaded : (refuse_highway(), nullptr);
  }();
  return handle;
}

/// \param name  of the function in the library, mangled
template <typename Function>
Function* real(const char* name) {
  void* const found = dlsym(highway(), name);
  if (found == nullptr) refuse_highway();
  return reinterpret_cast<Function*>(found);
}

}  // namespace
}  // namespace touchtrial::engine

using touchtrial::engine::real;

std::int64_t hwy::SupportedTargets() {
  static auto* const found = real<decltype(SupportedTargets)>("_ZN3hwy16SupportedTargetsEv");
  return found();
}

hwy::ChosenTarget& hwy::GetChosenTarget() {
  static auto* const found = real<decltype(GetChosenTarget)>("_ZN3hwy15GetChosenTargetEv");
  return found();
}

void* hwy::AllocateAlignedBytes(std::size_t payload_size, AllocPtr alloc_ptr, void* opaque_ptr) {
  static auto* const found =
      real<decltype(AllocateAlignedBytes)>("_ZN3hwy20AllocateAlignedBytesEmPFPvS0_mES0_");
  return found(payload_size, alloc_ptr, opaque_ptr);
}

void hwy::FreeAlignedBytes(const void* aligned_pointer, FreePtr free_ptr, void* opaque_ptr) {
  static auto* const found =
      real<decltype(FreeAlignedBytes)>("_ZN3hwy16FreeAlignedBytesEPKvPFvPvS2_ES2_");
  found(aligned_pointer, free_ptr, opaque_ptr);
}

/// The checks in Highway's headers call this function in builds that do not optimise. It looks up
/// no symbol, because a bug of the program must be reported in any case.
void hwy::Abort(const char* file, int line, const char* format, ...) {
  std::fprintf(stderr, "Abort at %s:%d: ", file, line);
  std::va_list values;
  va_start(values, format);
  std::vfprintf(stderr, format, values);
  va_end(values);
  std::fputc('\n', stderr);
  std::abort();
}
