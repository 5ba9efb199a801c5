// Preloaded into the program: a machine whose wall clock is wrong (FAKE_CLOCK_AHEAD_S, seconds), or
// whose disk takes so many bytes more of a program and is then full (FAKE_DISK_BYTES).
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <ctime>

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

long number_of(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? 0 : std::atol(text);
}

/// Standard output and error stay writable, so that the program can say what is wrong.
bool is_full(int file, std::size_t bytes) {
  static const long room = number_of("FAKE_DISK_BYTES");
  static std::atomic<long> taken{0};
  struct stat status {};
  if (room == 0 || file <= STDERR_FILENO) return false;
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  if (taken.fetch_add(static_cast<long>(bytes)) + static_cast<long>(bytes) <= room) return false;
  errno = ENOSPC;
  return true;
}

ssize_t write_at(int file, const void* data, std::size_t bytes, off_t offset) {
  if (is_full(file, bytes)) return -1;
  return ::syscall(SYS_pwrite64, file, data, bytes, offset);
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, struct timespec* time) noexcept {
  const auto result = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += number_of("FAKE_CLOCK_AHEAD_S");
  return result;
}

ssize_t write(int file, const void* data, std::size_t bytes) {
  if (is_full(file, bytes)) return -1;
  return ::syscall(SYS_write, file, data, bytes);
}

ssize_t pwrite(int file, const void* data, std::size_t bytes, off_t offset) {
  return write_at(file, data, bytes, offset);
}

ssize_t pwrite64(int file, const void* data, std::size_t bytes, off64_t offset) {
  return write_at(file, data, bytes, offset);
}
}
