/// \file Sets the force to zero however the program ends. One source file a platform.
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo_control.hpp"

#include <string>

namespace touchtrial::device {

/// While this lives, signals and crashes halt a device. One at a time in a program.
///
/// A request to end (SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU) or to sleep (SIGTSTP, which is
/// Ctrl-Z, SIGTTIN, SIGTTOU) halts the device, requests an emergency stop of the servo, and stores
/// the signal, so that the command can put its things in order and leave with `exit_code`. After a
/// second such signal, and 20 ms, the action happens that the signal has without this.
///
/// A crash (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, or SIGQUIT, which is Ctrl-\) and
/// std::terminate halt the device. After 20 ms, in which the driver's own thread sends zeros, the
/// earlier handler or the default action follows. If the driver's thread itself crashed, or the
/// process is killed (SIGKILL), only the device's own watch over its link is left.
class StopOnSignals {
 public:
  /// \param device,control  must outlive this
  /// \throws std::logic_error if there is another
  StopOnSignals(HapticDevice& device, ServoControl& control);
  /// Puts the earlier handlers back.
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

  /// Sets a function that puts something back, for instance the terminal, before the program dies
  /// of a second signal or a crash. The handler calls it after the device is halted, so it may only
  /// do what is safe there. Any thread. \param put_back  null: nothing
  static void before_dying(void (*put_back)() noexcept) noexcept;

  /// Any thread.
  /// \return whether the program was asked to end
  [[nodiscard]] static bool asked() noexcept;
  /// \return the exit code that a shell expects: 128 + the signal's number; 0 if not asked
  [[nodiscard]] static int exit_code() noexcept;
  /// \return one line, for instance "stopped by SIGTERM; the force is zero"; empty if not asked
  [[nodiscard]] static std::string message();
};

}  // namespace touchtrial::device
