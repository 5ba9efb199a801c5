/// \file The contents of the experimenter's window.
#pragma once

#include "app/windows/experimenter/experimenter_desk.hpp"
#include "core/vec.hpp"

#include <array>
#include <cstddef>

namespace touchtrial::app {

/// Status, a button for each action, and the open question with a field or buttons for its answer.
/// Belongs to one thread at a time. Call `draw` between ImGui::NewFrame and ImGui::Render, with the
/// fonts of load_fonts.
class ConsolePanel {
 public:
  /// \param desk  must outlive this
  explicit ConsolePanel(ExperimenterDesk& desk) : desk_(desk) {}

  /// \param size  size of the window, which the panel fills, in window units
  /// \param density  as ScreenScale::density
  /// \param may_write  false while the keyboard is the participant's
  void draw(Vec2 size, float density, bool may_write);
  /// Whether a field has the keyboard.
  [[nodiscard]] bool is_writing() const noexcept { return is_writing_; }
  /// Whether a new field is about to get the keyboard. Until then letters must wait.
  [[nodiscard]] bool is_settling() const noexcept { return wants_keyboard_; }

 private:
  void draw_actions(const ExperimenterView& view, float density);
  void draw_question(const ExperimenterView& view, float density, bool may_write);
  void draw_choices(const ExperimenterQuestion& question);
  /// \return whether the line was ended by Enter
  [[nodiscard]] bool draw_line(const ExperimenterQuestion& question, float density, bool may_write);

  ExperimenterDesk& desk_;
  bool wants_keyboard_ = false;  ///< a new field, which ImGui has not made active yet
  bool is_writing_ = false;
  std::size_t questions_ = 0;  ///< as of the view, when text_ was begun
  std::array<char, 501> text_{};
};

}  // namespace touchtrial::app
