#include "app/participant/feedback_screen.hpp"

#include "app/participant/page_layout.hpp"
#include "app/participant/picture_grid.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::app {

FeedbackScreen::FeedbackScreen(const session::FeedbackStep& step, const ScreenContext& context,
                               std::vector<std::string> labels)
    : step_(step), context_(context), labels_(std::move(labels)) {}

std::string FeedbackScreen::name_of(int position) const {
  const auto index = static_cast<std::size_t>(position);
  return index < labels_.size() ? labels_[index] : "";
}

void FeedbackScreen::paint(Canvas& canvas) {
  const Words& words = *context_.words;
  const bool correct = step_.answered == step_.correct;
  const std::string title = correct ? words.correct_title : words.wrong_title;
  if (context_.sight == design::Sight::blindfold) {
    draw_card(canvas, title, std::string(words.it_was) + ": " + name_of(step_.correct));
  } else {
    const Box area = draw_heading(canvas, title);
    std::vector<int> positions;
    if (!correct) positions.push_back(step_.answered);
    positions.push_back(step_.correct);
    paint_pictures(canvas, area, positions);
  }
  draw_footer(canvas, {{kNextTarget, words.next}});
}

void FeedbackScreen::paint_pictures(Canvas& canvas, const Box& area,
                                    const std::vector<int>& positions) {
  const Words& words = *context_.words;
  const double unit = canvas.unit();
  const double line = 48.0 * unit;
  // Captions need room beside each other, however small the pictures are.
  const double least = 300.0 * unit;
  std::vector<Vec2> sizes;
  double widest = 0.0;
  for (const int position : positions) {
    sizes.push_back((1.0 / context_.glass->mm_per_unit) *
                    context_.shelf->size_mm(name_of(position)));
    widest = std::max(widest, sizes.back().x);
  }
  const double gap = std::max(64.0 * unit, least - widest);
  const PictureGrid grid = lay_out_pictures(sizes, area.inset(8.0 * unit), gap, line);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Box& picture = grid.pictures[i];
    const bool right = positions[i] == step_.correct;
    canvas.picture(*context_.shelf, name_of(positions[i]), picture);
    if (right) canvas.outline(picture.inset(-4.0 * unit), tone::kGood, 6.0 * unit, 6.0 * unit);
    const double width = std::max(picture.width + 40.0 * unit, least);
    canvas.label({picture.x + (picture.width - width) / 2.0, picture.bottom() + 12.0 * unit, width,
                  line - 12.0 * unit},
                 right ? Letters::strong : Letters::body, right ? tone::kGood : tone::kText,
                 right ? words.it_was_this : words.your_answer);
  }
}

std::optional<session::StepReply> FeedbackScreen::activate(int /*id*/, Time /*at*/) {
  return session::StepReply{};
}

}  // namespace touchtrial::app
