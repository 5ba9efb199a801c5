/// \file The servo's thread, and a run on it while another thread serves the user.
#pragma once

#include "device/platform/realtime.hpp"
#include "device/servo/servo_control.hpp"

#include <chrono>
#include <functional>
#include <future>
#include <memory>

namespace touchtrial::device {

/// A thread that requests real-time scheduling once and then runs work items in sequence: every
/// trial of a session. All functions belong to the thread that created it.
class ServoThread {
 public:
  /// Returns once the thread has its scheduling.
  explicit ServoThread(const SchedulingRequest& request = {});
  /// Waits for the work to end. Its exception, if any, is lost.
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// The scheduling that the thread obtained, for the record and for PacedClock::default_spin.
  [[nodiscard]] const SchedulingObtained& scheduling() const noexcept;

  /// Runs this on the thread and returns at once.
  /// \throws std::logic_error if previous work was not waited for
  void start(std::function<void()> work);
  /// \return whether work is running. False does not replace `wait`.
  [[nodiscard]] bool running() const noexcept;
  /// Waits for the work to end and rethrows its exception. Returns at once without work.
  void wait();
  /// `start` and `wait`.
  void run(std::function<void()> work);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// One run on a ServoThread, as a scope. However the scope is left, even by an exception, the force
/// is off and the thread idle before objects of the run are destroyed. Belongs to the thread that
/// created it.
class RunningServo {
 public:
  /// \param thread,control  must outlive this; the control is that of the run's ServoHooks
  /// \param work  calls run_servo
  /// \throws std::logic_error if the thread is at work
  RunningServo(ServoThread& thread, ServoControl& control, std::function<void()> work);
  /// Requests an emergency stop and waits for the end, unless `finish` has returned.
  ~RunningServo();
  RunningServo(const RunningServo&) = delete;
  RunningServo& operator=(const RunningServo&) = delete;

  /// \param timeout  timeout
  /// \return whether it still runs
  [[nodiscard]] bool runs(std::chrono::nanoseconds timeout = {}) const;
  /// Waits for the end and rethrows the work's exception. Call it once.
  void finish();

 private:
  ServoThread& thread_;
  ServoControl& control_;
  std::future<void> ended_;
};

}  // namespace touchtrial::device
