/// \file The thread on which a device's servo runs.
#pragma once

#include "device/platform/realtime.hpp"

#include <functional>
#include <memory>

namespace touchtrial::device {

/// A thread that asked for real-time scheduling once, when it was made, and then runs one piece of
/// work after another: every trial of a session. All functions belong to the thread that made it.
class ServoThread {
 public:
  /// Returns once the thread has its scheduling.
  explicit ServoThread(const SchedulingRequest& request = {});
  /// Waits for the work to end. An exception that it ended with is lost.
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// What the thread got, for the record and for PacedClock::usual_spin.
  [[nodiscard]] const SchedulingObtained& scheduling() const noexcept;

  /// Runs this on the thread and returns at once.
  /// \throws std::logic_error if work is running that nobody has waited for
  void start(std::function<void()> work);
  /// Whether work is running. False does not replace `wait`.
  [[nodiscard]] bool running() const noexcept;
  /// Waits for the work to end and throws what it threw. At once if there is none.
  void wait();
  /// `start` and `wait`.
  void run(std::function<void()> work);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::device
