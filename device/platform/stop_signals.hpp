/// \file Sets the force to zero when signals or crashes end the program. One source file per platform.
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo_control.hpp"

#include <string>

namespace touchtrial::device {

/// While this object lives, signals and crashes halt a device. A program may have one at a time.
///
/// A request to end (SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU) or to suspend (SIGTSTP, which is
/// Ctrl-Z, SIGTTIN, SIGTTOU) halts the device, requests an emergency stop of the servo, and stores
/// the signal, so that the command can clean up and exit with `exit_code`. After a second such
/// signal the default action follows within 20 ms.
///
/// A crash (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, or SIGQUIT, which is Ctrl-\) and
/// std::terminate halt the device. After 20 ms, in which the driver's own thread sends zeros, the
/// previous handler or the default action follows. If the driver's thread itself crashed, or the
/// process is killed (SIGKILL), only the device's own link watchdog remains.
class StopOnSignals {
 public:
  /// \param device,control  must outlive this
  /// \throws std::logic_error if another exists
  StopOnSignals(HapticDevice& device, ServoControl& control);
  /// Restores the previous handlers.
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

  /// Sets a function that restores, for instance, the terminal before a second signal or a crash
  /// ends the program. A signal handler calls it, so it must be async-signal-safe. Thread-safe.
  /// \param cleanup  null: none
  static void set_crash_cleanup(void (*cleanup)() noexcept) noexcept;

  /// May be called from any thread.
  /// \return whether the program was asked to end
  [[nodiscard]] static bool stop_requested() noexcept;
  /// \return the exit code that a shell expects: 128 + the signal's number; 0 otherwise
  [[nodiscard]] static int exit_code() noexcept;
  /// \return one line, for instance "stopped by SIGTERM; the force is zero"; empty otherwise
  [[nodiscard]] static std::string message();
};

}  // namespace touchtrial::device
