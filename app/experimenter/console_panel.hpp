/// \file The contents of the experimenter's window.
#pragma once

#include "core/vec.hpp"
#include "protocols/session/experimenter.hpp"

#include <array>
#include <deque>
#include <functional>
#include <string>

namespace touchtrial::app {

/// Status, buttons, and a field for text. Pause and comfort stop take effect at once; the reason is
/// written afterwards and becomes a note (pause) or a deviation (comfort stop). Belongs to one
/// thread at a time. Call `draw` between ImGui::NewFrame and ImGui::Render, with the fonts of
/// load_fonts.
class ConsolePanel {
 public:
  using Ask = std::function<void(const session::ExperimenterRequest&)>;
  /// \param ask  `draw` calls it once with each request
  explicit ConsolePanel(Ask ask) : ask_(std::move(ask)) {}

  /// \param size  size of the window, which the panel fills, in window units
  /// \param density  as ScreenScale::density
  /// \param may_write  false while the keyboard is the participant's
  void draw(const session::SessionStatus& status, Vec2 size, float density, bool may_write);
  /// Whether a field takes letters.
  [[nodiscard]] bool is_writing() const noexcept { return is_writing_; }

 private:
  enum class Draft { none, pause_reason, stop_reason, note, deviation, abort };
  void draw_buttons(const session::SessionStatus& status, float density);
  void draw_draft(float density, bool may_write);
  void draw_codes();
  void draw_asked();
  void begin(Draft draft);
  void send();
  void ask(session::ExperimenterRequest::Kind kind, const std::string& text = {},
           const std::string& code = {});

  Ask ask_;
  Draft draft_ = Draft::none;
  bool is_begun_ = false;  ///< the field needs the keyboard focus
  bool is_writing_ = false;
  std::array<char, 64> code_{};
  std::array<char, 501> text_{};
  std::deque<std::string> asked_;  ///< newest first
};

}  // namespace touchtrial::app
