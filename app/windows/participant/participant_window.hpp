/// \file The participant's window.
#pragma once

#include "app/windows/glfw_support.hpp"
#include "app/windows/participant/cues.hpp"
#include "app/windows/participant/input_event.hpp"
#include "core/plane.hpp"
#include "device/drivers/mouse/pointer_exchange.hpp"
#include "engine/pictures/colour_image.hpp"
#include "protocols/session/participant.hpp"
#include "study/ask.hpp"
#include "study/study.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::app {

class ExperimenterDesk;
class Screen;

struct ParticipantWindowOptions {
  /// Number of the monitor for full screen, from 1 as the system counts; ignored with `size_px`.
  int monitor = 1;
  /// Size of a window, instead of full screen.
  std::optional<std::pair<int, int>> size_px;
  /// The study's language, texts, text size, contrast and sight.
  study::SessionPlan session;
  /// Pictures of the originals by label, including those of practice, and pictures of instruction
  /// pages by page_picture(name).
  std::map<std::string, GreyImage> pictures;
  double pitch_mm = 0.2;    ///< the study's pitch, which gives the pictures' true size
  double rate_hz = 1000.0;  ///< rate of the servo
  /// Whether several methods make textures: the participant is asked which picture fits best.
  bool has_several_methods = false;
  /// The touch required before Enter ends an exploration, over all explorations of a presentation.
  study::MinTouch min_touch{0.0, 0.0};
  study::TrialQuestion trial_question{};  ///< question of the study's trials
  double stiffness_n_per_mm =
      0.0;  ///< stiffness of the planes' wall; only needed if planes have a clock
  /// How long each plane is announced, in a trial with several planes.
  std::chrono::milliseconds interval_pause{1000};
  /// Returns the explored device; called when each plane comes on.
  std::function<device::HapticDevice&()> device;
  /// Null: silent. Must outlive the window.
  Cues* cues = nullptr;
  /// The mouse device's exchange; the window then shows plane and stylus. Null: another device.
  /// Must outlive the window.
  device::PointerExchange* pointer = nullptr;
  /// Called on the main thread with 1 for Page Down, -1 for Page Up and 0 for Escape, to page
  /// through the screens in a preview. Null, as in every session: these keys have no effect.
  std::function<void(int pages)> turn_page;
  /// Shows a second window for the experimenter; null: none. Must outlive the window.
  ExperimenterDesk* console = nullptr;
  /// Number of that window's monitor, from 1. If not set: another monitor if this window fills one,
  /// otherwise beside this window.
  std::optional<int> console_monitor;
};

/// Why the window was closed.
enum class WindowEnd {
  closed,        ///< closed by the window manager
  monitor_lost,  ///< unplugged
  signal,        ///< the program was asked to end
};

/// Three threads use the window. The main thread constructs it, calls `pump` and destroys it; it
/// stamps events on arrival with steady_clock, the servo's clock. The window's own thread draws.
/// The session's thread calls the functions of Participant and does not wait for frames.
///
/// While a plane is on, the space bar is a comfort stop and Enter ends the exploration; neither
/// needs the drawing thread. Enter before the minimum touch shows a request to touch. Escape has no
/// effect.
///
/// In a trial with several planes, Enter does not end a plane. While the next plane is announced,
/// the space bar stops that plane as soon as it is on. The screen shows the number of the plane and
/// the progress of its clock by position; neither this nor the tone for too much force depends on
/// the force of a texture.
///
/// The experimenter's window, if there is one, uses the same threads. Whichever window has the
/// focus, keys go to the participant's window unless they are text typed into the experimenter's;
/// while a plane is on, all keys do.
class ParticipantWindow final : public session::Participant {
 public:
  /// \throws DeviceError with the remedy if the display, OpenGL 3.2, the monitor or a font for the
  ///   participant's texts is missing
  explicit ParticipantWindow(const ParticipantWindowOptions& options);
  ~ParticipantWindow() override;
  ParticipantWindow(const ParticipantWindow&) = delete;
  ParticipantWindow& operator=(const ParticipantWindow&) = delete;

  /// \name Main thread
  ///@{
  /// Processes events until `timeout` has passed or an event arrived.
  void pump(std::chrono::milliseconds timeout);
  /// \throws exceptions of the drawing thread
  void check() const;
  /// The scale of the monitor that shows the window.
  [[nodiscard]] ScreenScale screen() const;
  ///@}

  /// \name The session's thread
  ///@{
  void see_pictures(const std::vector<std::string>& labels) override;
  /// Blocks for up to 10 ms. A step that a pause interrupts later continues in its previous state.
  /// \return nothing before the reply, during a pause, and once the window is closed
  [[nodiscard]] std::optional<session::StepReply> show_step(const session::Step& step) override;
  /// Shows a screen outside of a session. Blocks for up to 10 ms.
  /// \return its reply, once; nothing once the window is closed
  [[nodiscard]] std::optional<session::StepReply> show_step(const std::shared_ptr<Screen>& screen);
  /// \throws std::logic_error if the options have no device
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override;
  /// Shows the screen for a plane, for a device that the caller provides.
  void show_exploring(const PlaneGeometry& plane);
  /// Forwards the participant's requests; an emergency stop once the window is closed.
  void while_exploring(device::ServoControl& servo) override;
  ///@}
  void feel(const device::ServoSample& sample) noexcept override;

  /// \name Any thread
  ///@{
  [[nodiscard]] std::optional<WindowEnd> end_reason() const noexcept;
  /// How long another program has had the keyboard focus; 0 while the session has it, and before it
  /// first had it. While a plane is on, the window takes the focus back.
  [[nodiscard]] std::chrono::milliseconds time_without_focus() const noexcept;
  /// Whether the focus was lost while a plane was on, since the last call.
  [[nodiscard]] bool take_focus_loss() noexcept;
  /// Whether a plane is on.
  [[nodiscard]] bool is_exploring() const noexcept;
  /// Whether the participant is choosing an answer. Call it on the thread of `show_step`.
  [[nodiscard]] bool is_answering() const noexcept;
  /// Acts as if the window manager had closed the window.
  void close() noexcept;
  /// Acts as if the event had just arrived.
  void inject(const InputEvent& event);
  /// Waits until the newest step is visible.
  /// \return false after the timeout, or if the window is closed
  [[nodiscard]] bool wait_until_shown(std::chrono::milliseconds timeout);
  /// Waits for the next picture of the window.
  /// \throws DeviceError after 5 min
  [[nodiscard]] engine::ColourImage picture();
  /// Waits for the next picture of the experimenter's window.
  /// \throws std::logic_error if there is none
  [[nodiscard]] engine::ColourImage console_picture();
  ///@}

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs a session on a new thread, while the calling main thread processes the window's events.
/// \throws exceptions of the session or the drawing thread
void run_beside(ParticipantWindow& window, const std::function<void()>& session);

}  // namespace touchtrial::app
