#include "support/realtime_watch.hpp"

#include "device/platform/realtime.hpp"
#include "support/sanitized.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include <dlfcn.h>
#include <pthread.h>

namespace {

std::atomic<std::int64_t> allocations{0};
std::atomic<std::int64_t> frees{0};
std::atomic<std::int64_t> locks{0};

void count(std::atomic<std::int64_t>& offences) noexcept {
  if (touchtrial::device::RealtimeRegion::entered())
    offences.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

namespace touchtrial {

RealtimeOffences take_realtime_offences() noexcept {
  return {allocations.exchange(0), frees.exchange(0), locks.exchange(0)};
}

}  // namespace touchtrial

#ifdef TOUCHTRIAL_SANITIZED

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));

namespace {

[[maybe_unused]] const int hooked = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { count(allocations); },
    [](const volatile void* block) {
      if (block != nullptr) count(frees);
    });

}  // namespace

bool touchtrial::locks_are_watched() noexcept {
  return false;
}

#else

bool touchtrial::locks_are_watched() noexcept {
  return true;
}

// Aliases of the C library's functions, for replacements.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) noexcept {
  count(allocations);
  return __libc_malloc(size);
}

void* calloc(std::size_t number, std::size_t size) noexcept {
  count(allocations);
  return __libc_calloc(number, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  count(allocations);
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count(allocations);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}

void free(void* block) noexcept {
  if (block != nullptr) count(frees);
  __libc_free(block);
}
}

namespace {

/// The replaced function with this name, looked up at the first call. Thread-safe.
template <typename Function>
class ReplacedFunction {
 public:
  constexpr explicit ReplacedFunction(const char* name) noexcept : name_(name) {}

  [[nodiscard]] Function get() noexcept {
    Function found = found_.load(std::memory_order_relaxed);
    if (found == nullptr) {
      found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name_));
      found_.store(found, std::memory_order_relaxed);
    }
    return found;
  }

 private:
  const char* name_;
  std::atomic<Function> found_{nullptr};
};

constinit ReplacedFunction<int (*)(pthread_mutex_t*)> mutex_lock("pthread_mutex_lock");
constinit ReplacedFunction<int (*)(pthread_mutex_t*)> mutex_trylock("pthread_mutex_trylock");
constinit ReplacedFunction<int (*)(pthread_rwlock_t*)> rwlock_rdlock("pthread_rwlock_rdlock");
constinit ReplacedFunction<int (*)(pthread_rwlock_t*)> rwlock_wrlock("pthread_rwlock_wrlock");

}  // namespace

extern "C" {
int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  count(locks);
  return mutex_lock.get()(mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  count(locks);
  return mutex_trylock.get()(mutex);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  count(locks);
  return rwlock_rdlock.get()(lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  count(locks);
  return rwlock_wrlock.get()(lock);
}
}

#endif
