/// \file The screen of `screen calibrate`: a frame to match with a bank card.
#pragma once

#include "app/windows/participant/screen.hpp"

#include <optional>

namespace touchtrial::app {

/// The user holds a card against the frame, and resizes the frame with the arrow keys until both
/// match; Enter replies. Texts are English, as in all windows for experimenters.
class CardScreen final : public Screen {
 public:
  /// \param mm_per_unit  the initial estimate
  explicit CardScreen(double mm_per_unit);

  /// The scale at which the frame matches the card: 25.4 / 400 to 25.4 / 40.
  [[nodiscard]] double mm_per_unit() const noexcept;

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int /*id*/, Time /*at*/) override {
    return session::StepReply{};
  }
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }
  bool handle_special_key(const InputEvent& event) override;

  double width_;  ///< width of the frame, window units
};

}  // namespace touchtrial::app
