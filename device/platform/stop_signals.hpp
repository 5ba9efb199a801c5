/// \file Zero force however the program ends. One source file a platform.
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo_control.hpp"

#include <string>

namespace touchtrial::device {

/// While this lives, signals and crashes halt a device. One at a time in a program.
///
/// Asked to end (SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU) or to sleep (SIGTSTP, which is Ctrl-Z,
/// SIGTTIN, SIGTTOU): the device is halted, the servo is asked for an
/// emergency stop, and the signal is remembered, so that the command can put its things in order
/// and leave with `exit_code`. A second such signal does what it would have done without this, 20
/// ms later.
///
/// Crashed (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT), asked to with Ctrl-\ (SIGQUIT), or
/// std::terminate: the device is halted, and after 20 ms, in which the driver's own thread sends
/// zeros, the earlier handler or the default action has its way. If it is the driver's thread that
/// crashed, or the process is killed (SIGKILL), only the device's own watch over its link is left.
class StopOnSignals {
 public:
  /// \param device,control  must outlive this
  /// \throws std::logic_error if there is another
  StopOnSignals(HapticDevice& device, ServoControl& control);
  /// The earlier handlers are back.
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

  /// What else is to be put back before the program dies of a second signal or a crash: a
  /// terminal, say. Called after the device is halted, in the handler, so only what is safe there;
  /// null: nothing. Any thread.
  static void before_dying(void (*put_back)() noexcept) noexcept;

  /// Whether the program was asked to end. Any thread.
  [[nodiscard]] static bool asked() noexcept;
  /// What a shell expects of a program that ended so: 128 + the signal's number; 0 if not asked.
  [[nodiscard]] static int exit_code() noexcept;
  /// One line: "stopped by SIGTERM; the force is zero"; empty if not asked.
  [[nodiscard]] static std::string message();
};

}  // namespace touchtrial::device
