#include "engine/image_formats/stderr_capture.hpp"

#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace touchtrial::engine {

StderrCapture::StderrCapture() noexcept {
  std::fflush(stderr);
  memory_ = ::memfd_create("stderr", MFD_CLOEXEC);
  if (memory_ < 0) return;
  saved_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (saved_ >= 0) ::dup2(memory_, STDERR_FILENO);
}

StderrCapture::~StderrCapture() {
  restore();
  if (memory_ >= 0) ::close(memory_);
}

std::string StderrCapture::take() {
  restore();
  std::string text(std::size_t{1} << 16U, '\0');
  const ssize_t size = memory_ < 0 ? 0 : ::pread(memory_, text.data(), text.size(), 0);
  text.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
  return text;
}

void StderrCapture::restore() noexcept {
  if (saved_ < 0) return;
  std::fflush(stderr);
  ::dup2(saved_, STDERR_FILENO);
  ::close(std::exchange(saved_, -1));
}

}  // namespace touchtrial::engine
