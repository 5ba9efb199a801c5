/// \file Sets the force to zero however the program ends. One source file a platform.
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo_control.hpp"

#include <string>

namespace touchtrial::device {

/// While this object lives, signals and crashes halt a device. A program may have one at a time.
///
/// A request to end (SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU) or to suspend (SIGTSTP, which is
/// Ctrl-Z, SIGTTIN, SIGTTOU) halts the device, requests an emergency stop of the servo, and stores
/// the signal, so that the command can close everything and exit with `exit_code`. After a second
/// such signal, and 20 ms, the signal has its usual effect.
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

  /// Sets a function that restores something, for instance the terminal, before a second signal or
  /// a crash kills the program. The handler calls it after the device is halted, so it may only do
  /// what is safe in a signal handler. This function may be called from any thread.
  /// \param put_back  null: nothing
  static void before_dying(void (*put_back)() noexcept) noexcept;

  /// May be called from any thread.
  /// \return whether the program was asked to end
  [[nodiscard]] static bool asked() noexcept;
  /// \return the exit code that a shell expects: 128 + the signal's number; 0 if not asked
  [[nodiscard]] static int exit_code() noexcept;
  /// \return one line, for instance "stopped by SIGTERM; the force is zero"; empty if not asked
  [[nodiscard]] static std::string message();
};

}  // namespace touchtrial::device
