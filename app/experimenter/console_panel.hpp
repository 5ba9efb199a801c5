/// \file What stands in the experimenter's window.
#pragma once

#include "core/vec.hpp"
#include "protocols/session/experimenter.hpp"

#include <array>
#include <deque>
#include <functional>
#include <string>

namespace touchtrial::app {

/// Status, buttons, and a line to write in. Pause and comfort stop are asked for at once; their
/// reason is written after it and becomes a note. Belongs to one thread at a time; `draw` between
/// ImGui::NewFrame and ImGui::Render, with the fonts of load_fonts.
class ConsolePanel {
 public:
  using Ask = std::function<void(const session::ExperimenterRequest&)>;
  /// \param ask  called from `draw` with each request, once
  explicit ConsolePanel(Ask ask) : ask_(std::move(ask)) {}

  /// \param size  window units, all of which are covered
  /// \param density  window units for each at 96 per inch
  /// \param may_write  otherwise text waits: the keyboard is the participant's
  void draw(const session::SessionStatus& status, Vec2 size, float density, bool may_write);
  /// A field takes letters.
  [[nodiscard]] bool is_writing() const noexcept { return is_writing_; }

 private:
  enum class Draft { none, pause_reason, stop_reason, note, deviation, abort };
  void draw_buttons(const session::SessionStatus& status, float density);
  void draw_draft(float density, bool may_write);
  void draw_asked();
  void begin(Draft draft);
  void send();
  void ask(session::ExperimenterRequest::Kind kind, const std::string& text = {},
           const std::string& code = {});

  Ask ask_;
  Draft draft_ = Draft::none;
  bool is_begun_ = false;  ///< the field is to take the letters
  bool is_writing_ = false;
  std::array<char, 64> code_{};
  std::array<char, 501> text_{};
  std::deque<std::string> asked_;  ///< newest first
};

}  // namespace touchtrial::app
