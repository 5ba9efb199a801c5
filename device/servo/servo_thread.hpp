/// \file The servo's thread, and a run on it while the calling thread serves the user.
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
  /// Returns once the thread has requested its scheduling.
  explicit ServoThread(const SchedulingRequest& request = {});
  /// Waits for the work to end. Its exception, if any, is lost.
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// The scheduling that the thread obtained, for the record and for PacedClock::default_spin.
  [[nodiscard]] const SchedulingObtained& scheduling() const noexcept;

  /// Starts this work on the thread and returns at once.
  /// \throws std::logic_error unless `wait` was called for the previous work
  void start(std::function<void()> work);
  /// \return whether work is running. False does not replace `wait`.
  [[nodiscard]] bool running() const noexcept;
  /// Waits for the work to end and rethrows its exception. Returns at once if there is no work.
  void wait();
  /// `start` and `wait`.
  void run(std::function<void()> work);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Scope of one run on a ServoThread. When the scope ends, even by an exception, the force is off
/// and the thread idle before objects of the run are destroyed. Belongs to the thread that created
/// it.
class RunningServo {
 public:
  /// \param thread,control  must outlive this; the control is ServoHooks::control of the run
  /// \param work  calls run_servo
  /// \throws std::logic_error if the thread is running other work
  RunningServo(ServoThread& thread, ServoControl& control, std::function<void()> work);
  /// Requests an emergency stop and waits for the end, unless `finish` has returned.
  ~RunningServo();
  RunningServo(const RunningServo&) = delete;
  RunningServo& operator=(const RunningServo&) = delete;

  /// \param timeout  how long to wait for the end
  /// \return whether it is still running
  [[nodiscard]] bool is_running(std::chrono::nanoseconds timeout = {}) const;
  /// Waits for the end and rethrows the work's exception. Call it once.
  void finish();

 private:
  ServoThread& thread_;
  ServoControl& control_;
  std::future<void> completion_;
};

}  // namespace touchtrial::device
