// The system calls that libusb makes on the bus. This program's functions come before the C
// library's, so libusb finds these; calls for other files go to the kernel.
#include "device/drivers/falcon/usbfs_shim/usbfs_bus.hpp"

#include <cstdarg>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

using touchtrial::testing::UsbfsBus;

namespace {

int open_path(const char* path, int flags, mode_t mode) {
  if (path != nullptr && UsbfsBus::instance().serves(path)) return UsbfsBus::instance().open(path);
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

/// The third argument of open, which exists only with some flags.
mode_t mode_of(int flags, va_list arguments) {
  const bool given = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return given ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path(path, flags | O_LARGEFILE, mode);
}

// Fortified programs call this in place of open with two arguments.
int __open_2(const char* path, int flags) {
  return open_path(path, flags, 0);
}

int __open64_2(const char* path, int flags) {
  return open_path(path, flags | O_LARGEFILE, 0);
}

int close(int descriptor) {
  if (UsbfsBus::instance().is_node(descriptor)) {
    UsbfsBus::instance().close(descriptor);
    return 0;
  }
  return static_cast<int>(syscall(SYS_close, descriptor));
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (UsbfsBus::instance().is_node(descriptor)) {
    return UsbfsBus::instance().ioctl(descriptor, request, argument);
  }
  return static_cast<int>(syscall(SYS_ioctl, descriptor, request, argument));
}

}  // extern "C"
