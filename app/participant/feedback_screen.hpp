/// \file What a practice answer was, and what it should have been.
#pragma once

#include "app/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

class FeedbackScreen final : public Screen {
 public:
  FeedbackScreen(const session::FeedbackStep& step, const ScreenContext& context,
                 std::vector<std::string> labels);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }

  [[nodiscard]] std::string name_of(int position) const;
  void paint_pictures(Canvas& canvas, const Box& area, const std::vector<int>& positions);

  session::FeedbackStep step_;
  ScreenContext context_;
  std::vector<std::string> labels_;
};

}  // namespace touchtrial::app
