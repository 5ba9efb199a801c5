/// \file The window that a participant sits before.
#pragma once

#include "app/participant/cues.hpp"
#include "app/participant/input_event.hpp"
#include "core/plane.hpp"
#include "device/mouse/pointer_exchange.hpp"
#include "engine/pictures/colour_image.hpp"
#include "protocols/session/participant.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::app {

class ConsoleExperimenter;

struct ParticipantWindowOptions {
  /// Full screen on this monitor, from 1 as the system counts them; not with `size_px`.
  int monitor = 1;
  /// A window of this size instead.
  std::optional<std::pair<int, int>> size_px;
  std::string language = "en";  ///< "en" or "de"; others are English
  design::Sight sight = design::Sight::curtain;
  /// Pictures of the originals by label, the practice's too.
  std::map<std::string, GreyImage> pictures;
  double pitch_mm = 0.2;    ///< of the study; with a picture's pixels its size on the screen
  double rate_hz = 1000.0;  ///< of the servo
  /// The device that is explored, asked for as each plane comes on.
  std::function<device::HapticDevice&()> device;
  Cues* cues = nullptr;  ///< null: silent; must outlive the window
  /// Of the device "mouse": the window then shows the plane and the stylus. Must outlive the
  /// window.
  device::PointerExchange* pointer = nullptr;
  /// A second window, for whoever runs the session. Must outlive the window; null: none.
  ConsoleExperimenter* console = nullptr;
  /// Where it comes up, from 1; none: wherever the system puts it.
  std::optional<int> console_monitor;
};

/// Why there is no participant any more.
enum class WindowGone {
  closed,        ///< by the window manager
  monitor_lost,  ///< unplugged
  signal,        ///< the program was asked to end
};

/// Three threads meet here. The main one makes it, calls `pump` and destroys it: events are taken
/// there and stamped with steady_clock, the servo's clock, as they arrive. A thread of the window's
/// own draws. The session's calls the functions of Participant and waits for no picture.
///
/// While a plane is on, the space bar is a comfort stop and Enter ends the exploration; both are
/// seen without the drawing thread. Escape does nothing.
///
/// The experimenter's window, if there is one, lives on the same threads. Keys that are not text
/// written there are the participant's, whichever window has the focus; while a plane is on, all
/// are.
class ParticipantWindow final : public session::Participant {
 public:
  /// \throws DeviceError with the remedy if there is no display, no OpenGL 3.2, or no such monitor
  explicit ParticipantWindow(const ParticipantWindowOptions& options);
  ~ParticipantWindow() override;
  ParticipantWindow(const ParticipantWindow&) = delete;
  ParticipantWindow& operator=(const ParticipantWindow&) = delete;

  /// \name Main thread
  ///@{
  /// Takes events until `longest` has gone by, or something came.
  void pump(std::chrono::milliseconds longest);
  /// \throws what the drawing thread threw
  void check() const;
  ///@}

  /// \name The session's thread
  ///@{
  void see_pictures(const std::vector<std::string>& labels) override;
  /// Blocks for up to 10 ms. Nothing once the window is gone, and as long as a pause lasts; a step
  /// that a pause interrupted goes on as it was.
  [[nodiscard]] std::optional<session::StepReply> attend(const session::Step& step) override;
  /// \throws std::logic_error if the options have no device
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override;
  /// The screen while a plane is on, for a device that somebody else brings.
  void show_exploring(const PlaneGeometry& plane);
  /// Hands on what the person asks for; an emergency stop once the window is gone.
  void exploring(device::ServoControl& servo) override;
  ///@}
  void feel(const device::ServoSample& sample) noexcept override;

  /// \name Any thread
  ///@{
  [[nodiscard]] std::optional<WindowGone> gone() const noexcept;
  /// As if the window manager had closed it.
  void close() noexcept;
  /// What is now to happen: as if the event had come by itself.
  void inject(const InputEvent& event);
  /// Waits until the newest step has been on the screen for a picture. \return false if it is not
  /// within the time, or the window is gone
  [[nodiscard]] bool wait_until_shown(std::chrono::milliseconds longest);
  /// What is on the screen: waits for a picture. \throws DeviceError if none comes within 5 min
  [[nodiscard]] engine::ColourImage picture();
  /// What is in the experimenter's window, likewise. \throws std::logic_error if there is none
  [[nodiscard]] engine::ColourImage console_picture();
  ///@}

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs a session on a thread of its own; this one, the main thread, takes the window's events
/// until it has ended. \throws what the session threw, or the drawing of the window
void run_beside(ParticipantWindow& window, const std::function<void()>& session);

}  // namespace touchtrial::app
