/// \file Standard error, caught for a while.
#pragma once

#include <string>

namespace touchtrial::engine {

/// From construction to `take()`, or destruction, everything that the process writes to file
/// descriptor 2 goes to memory. Instances must not overlap in time. Where the system has no spare
/// descriptor, nothing is caught.
class StderrCapture {
 public:
  StderrCapture() noexcept;
  ~StderrCapture();
  StderrCapture(const StderrCapture&) = delete;
  StderrCapture& operator=(const StderrCapture&) = delete;

  /// Ends the capture. \return at most the first 64 KiB of what was written
  [[nodiscard]] std::string take();

 private:
  void restore() noexcept;

  int memory_ = -1;  ///< descriptor of the memory file
  int saved_ = -1;   ///< where descriptor 2 went before
};

}  // namespace touchtrial::engine
