/// \file A servo that runs on its thread while another thread attends to the person.
#pragma once

#include "device/servo/servo_control.hpp"
#include "device/servo/servo_thread.hpp"

#include <chrono>
#include <functional>
#include <future>

namespace touchtrial::device {

/// One run on a ServoThread, in a scope. However the scope is left, an exception of whoever attends
/// included, the force is off and the thread at rest: nothing that the run uses goes before it.
/// Belongs to the thread that made it.
class RunningServo {
 public:
  /// \param thread,control  must outlive this; the control is that of the run's ServoHooks
  /// \param work  calls run_servo
  /// \throws std::logic_error if the thread is at work
  RunningServo(ServoThread& thread, ServoControl& control, std::function<void()> work);
  /// Unless `finish` has returned: asks for an emergency stop and waits for the end.
  ~RunningServo();
  RunningServo(const RunningServo&) = delete;
  RunningServo& operator=(const RunningServo&) = delete;

  /// Whether it still runs. Waits that long for its end.
  [[nodiscard]] bool runs(std::chrono::nanoseconds patience = {}) const;
  /// Waits for the end and throws what the work threw. Once.
  void finish();

 private:
  ServoThread& thread_;
  ServoControl& control_;
  std::future<void> ended_;
};

}  // namespace touchtrial::device
