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
  /// \param has_keyboard  false while it belongs to the participant
  void draw(Vec2 size, float density, bool has_keyboard);
  /// Whether a field has the keyboard.
  [[nodiscard]] bool is_typing() const noexcept { return is_typing_; }
  /// Whether a new field is about to get the keyboard. Until then, letters must be held back.
  [[nodiscard]] bool is_focus_pending() const noexcept { return is_focus_pending_; }

 private:
  void draw_actions(const ExperimenterView& view, float density);
  void draw_question(const ExperimenterView& view, float density, bool has_keyboard);
  void draw_choices(const ExperimenterQuestion& question);
  /// \return whether the line was ended by Enter
  [[nodiscard]] bool draw_text_field(const ExperimenterQuestion& question, float density,
                                     bool has_keyboard);

  ExperimenterDesk& desk_;
  bool is_focus_pending_ = false;  ///< ImGui has not yet activated a new field
  bool is_typing_ = false;
  std::size_t question_number_ = 0;  ///< the view's question when text_ was started
  std::array<char, 501> text_{};
};

}  // namespace touchtrial::app
