#include "app/windows/participant/answer_screen.hpp"

#include "app/windows/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchtrial::app {
namespace {

constexpr double kBadge = 40.0;  ///< height of the number below a picture
constexpr double kBadgeSide = 34.0;
constexpr double kWordWidth = 300.0;  ///< width of a choice that is a word
constexpr double kWordHeight = 130.0;

}  // namespace

AnswerScreen::AnswerScreen(const session::AnswerStep& step, const ScreenContext& context,
                           std::vector<std::string> labels)
    : step_(step), context_(context), labels_(std::move(labels)) {}

int AnswerScreen::default_target() const noexcept {
  const bool is_ready = answered_at_ ? confidence_ > 0 : choice_ >= 0;
  return is_ready ? kNextTarget : -1;
}

std::string AnswerScreen::hint() const {
  const Words& words = *context_.words;
  if (is_fixed()) return words.now_fixed;
  if (choice_ >= 0) return words.changes_once;
  return fill_numbers(words.choose_hint, {{"keys", std::min(count(), 9)}});
}

std::string AnswerScreen::name_of(int position) const {
  const std::string& label = labels_[static_cast<std::size_t>(position)];
  return has_words() ? choice_text(*context_.words, label) : label;
}

void AnswerScreen::paint(Canvas& canvas) {
  const Words& words = *context_.words;
  draw_progress(canvas, progress_of(words, step_.trial, step_.total, step_.practice));
  if (answered_at_) return paint_confidence(canvas);
  const bool is_spoken = step_.sight == study::Sight::blindfold;
  const std::string& spoken_note =
      has_words() ? words.answer_spoken_choice : words.answer_spoken_text;
  const std::string note = step_.time_is_up ? words.time_is_up : (is_spoken ? spoken_note : "");
  const std::string& picture_title = is_spoken ? words.answer_spoken_title : words.answer_title;
  const Box area = draw_heading(canvas, has_words() ? title_of(words, title()) : picture_title,
                                note, step_.time_is_up ? tone::kWarn : tone::kQuiet);
  if (is_spoken) {
    paint_names(canvas, area);
  } else if (has_words()) {
    paint_words(canvas, area);
  } else {
    paint_pictures(canvas, area);
  }
  std::vector<FooterButton> buttons;
  if (step_.may_explore_again) buttons.push_back({kFeelAgainTarget, words.feel_again, false});
  // A spoken answer needs no button.
  if (!is_spoken || choice_ >= 0) buttons.push_back({kNextTarget, words.next, true, choice_ >= 0});
  draw_footer(canvas, buttons);
}

void AnswerScreen::paint_pictures(Canvas& canvas, const Box& area) {
  const double unit = canvas.unit();
  std::vector<Vec2> sizes;
  for (const std::string& label : labels_) {
    sizes.push_back((1.0 / context_.physical_scale->mm_per_unit) * context_.shelf->size_mm(label));
  }
  const double line = 30.0 * unit;
  Box room = area;
  room.height -= 2.0 * line;
  const PictureGrid grid =
      lay_out_pictures(sizes, room.inset(8.0 * unit), 32.0 * unit, kBadge * unit);
  for (int i = 0; i < count(); ++i) {
    paint_picture(canvas, i, grid.pictures[static_cast<std::size_t>(i)]);
  }
  canvas.draw_label({area.x, room.bottom(), area.width, line}, Letters::small,
                    is_fixed() ? tone::kText : tone::kQuiet, hint());
  draw_scale_bar(canvas, {area.x, room.bottom() + line, area.width, line}, context_, grid.scale);
}

void AnswerScreen::paint_picture(Canvas& canvas, int position, const Box& picture) {
  const double unit = canvas.unit();
  const bool is_chosen = choice_ == position;
  const bool is_open = !is_fixed();
  canvas.draw_picture(*context_.shelf, labels_[static_cast<std::size_t>(position)], picture);
  const Box rim = picture.inset(-4.0 * unit);
  if (is_chosen) {
    canvas.outline(rim, tone::kAccent, 6.0 * unit, 6.0 * unit);
  } else if (is_open && canvas.attention().hover == position) {
    canvas.outline(rim, tone::kAccent, 2.0 * unit, 6.0 * unit);
  }
  const double side = kBadgeSide * unit;
  const Box badge = {std::round(picture.x + (picture.width - side) / 2.0),
                     std::round(picture.bottom() + 10.0 * unit), side, side};
  paint_number(canvas, position, badge);
  if (!is_open) return;
  canvas.add_target(position, {picture.x, picture.y, picture.width, badge.bottom() - picture.y});
  canvas.draw_focus_ring(position, rim, 8.0 * unit);
}

void AnswerScreen::paint_number(Canvas& canvas, int position, const Box& badge) const {
  const bool is_chosen = choice_ == position;
  if (is_chosen) canvas.fill(badge, tone::kAccent, badge.width / 2.0);
  canvas.draw_label(badge, Letters::body,
                    is_chosen ? tone::kWhite : (is_fixed() ? tone::kQuiet : tone::kText),
                    std::to_string(position + 1));
}

void AnswerScreen::paint_words(Canvas& canvas, const Box& area) {
  const double unit = canvas.unit();
  const double line = 30.0 * unit;
  const double gap = 36.0 * unit;
  const double side = kBadgeSide * unit;
  const int shown = std::max(count(), 1);
  const double width = std::min(kWordWidth * unit, (area.width - gap * (shown - 1)) / shown);
  const double height = kWordHeight * unit;
  const double left = area.x + (area.width - shown * width - (shown - 1) * gap) / 2.0;
  const double top = std::round(area.y + 0.4 * (area.height - line - height - side - 12.0 * unit));
  for (int i = 0; i < count(); ++i) {
    const Box box = {std::round(left + i * (width + gap)), top, width, height};
    canvas.draw_button(i, box, name_of(i), ButtonKind::choice, !is_fixed(), choice_ == i);
    paint_number(
        canvas, i,
        {std::round(box.x + (width - side) / 2.0), box.bottom() + 12.0 * unit, side, side});
  }
  canvas.draw_label({area.x, area.bottom() - line, area.width, line}, Letters::small,
                    is_fixed() ? tone::kText : tone::kQuiet, hint());
}

void AnswerScreen::paint_names(Canvas& canvas, const Box& area) {
  const double unit = canvas.unit();
  const double gap = 14.0 * unit;
  const double line = 30.0 * unit;
  const double room = area.height - line;
  const int rows = count() > 5 ? (count() + 1) / 2 : std::max(count(), 1);
  const int columns = count() > 5 ? 2 : 1;
  const double width = 380.0 * unit;
  const double height = std::min(60.0 * unit, (room - gap * (rows - 1)) / rows);
  const double left = area.x + (area.width - columns * width - (columns - 1) * gap) / 2.0;
  const double top = area.y + (room - rows * height - (rows - 1) * gap) / 2.0;
  for (int i = 0; i < count(); ++i) {
    const Box box = {std::round(left + (i / rows) * (width + gap)),
                     std::round(top + (i % rows) * (height + gap)), width, height};
    // Shows no numbers, because the experimenter's alphabetical list has different ones.
    canvas.draw_button(i, box, name_of(i), ButtonKind::line, !is_fixed(), choice_ == i);
  }
  if (choice_ < 0) return;
  canvas.draw_label({area.x, area.y + room, area.width, line}, Letters::small, tone::kQuiet,
                    hint());
}

void AnswerScreen::paint_confidence(Canvas& canvas) {
  const Words& words = *context_.words;
  const double unit = canvas.unit();
  const Box area = draw_heading(canvas, words.confidence_title);
  const int levels = step_.confidence_levels;
  const double gap = 18.0 * unit;
  const double side =
      std::min(92.0 * unit, (std::min(area.width, 1000.0 * unit) - gap * (levels - 1)) / levels);
  const double width = levels * side + (levels - 1) * gap;
  const double x = std::round(area.x + (area.width - width) / 2.0);
  const double y = std::round(area.y + (area.height - side) * 0.42);
  for (int i = 0; i < levels; ++i) {
    canvas.draw_button(i, {std::round(x + i * (side + gap)), y, side, side}, std::to_string(i + 1),
                       ButtonKind::choice, true, confidence_ == i + 1);
  }
  const Box line = {x, y + side + 18.0 * unit, width, 34.0 * unit};
  const double half = width / 2.0 - gap;
  canvas.draw_label({line.x, line.y, half, line.height}, Letters::body, tone::kQuiet,
                    words.confidence_least, Align::left);
  canvas.draw_label({line.right() - half, line.y, half, line.height}, Letters::body, tone::kQuiet,
                    words.confidence_most, Align::right);
  draw_footer(canvas, {{kNextTarget, words.next, true, confidence_ > 0}});
}

bool AnswerScreen::handle_special_key(const InputEvent& event) {
  if (event.kind != InputEvent::Kind::key || event.key != Key::digit) return false;
  if (answered_at_) {
    if (event.digit >= 1 && event.digit <= step_.confidence_levels) {
      confidence_ = event.digit;
      focus(kNextTarget);
    }
  } else if (event.digit >= 1 && event.digit <= count()) {
    choose(event.digit - 1);
  }
  return true;
}

void AnswerScreen::choose(int position) {
  focus(kNextTarget);
  if (is_fixed() || position == choice_) return;
  if (choice_ >= 0) first_choice_ = choice_;
  choice_ = position;
}

std::optional<session::StepReply> AnswerScreen::activate(int id, Time at) {
  if (answered_at_ && id < kNextTarget) {
    confidence_ = id + 1;
    focus(kNextTarget);
    return std::nullopt;
  }
  if (id < kNextTarget) {
    choose(id);
    return std::nullopt;
  }
  session::StepReply reply;
  if (id == kFeelAgainTarget) {
    reply.explore_again = true;
    return reply;
  }
  if (!answered_at_ && step_.confidence_levels > 0) {
    answered_at_ = at;
    focus(-1);
    return std::nullopt;
  }
  reply.at = answered_at_.value_or(at);
  reply.answer = ChoiceAnswer{choice_, first_choice_};
  if (answered_at_) reply.confidence = confidence_;
  return reply;
}

FeedbackScreen::FeedbackScreen(const session::FeedbackStep& step, const ScreenContext& context,
                               std::vector<std::string> labels)
    : step_(step), context_(context), labels_(std::move(labels)) {}

std::string FeedbackScreen::name_of(int position) const {
  const auto index = static_cast<std::size_t>(position);
  return index < labels_.size() ? labels_[index] : "";
}

void FeedbackScreen::paint(Canvas& canvas) {
  const Words& words = *context_.words;
  const bool is_correct = step_.answered == step_.correct;
  const std::string title = is_correct ? words.correct_title : words.wrong_title;
  const auto* const choose = std::get_if<study::ChoiceQuestion>(&context_.trial_question.question);
  const bool has_words = choose != nullptr && choose->has_words();
  if (has_words) {
    draw_card(canvas, title,
              fill_placeholders(words.right_answer,
                                {{"label", choice_text(words, name_of(step_.correct))}}));
  } else if (context_.sight == study::Sight::blindfold) {
    draw_card(canvas, title, fill_placeholders(words.it_was, {{"label", name_of(step_.correct)}}));
  } else {
    const Box area = draw_heading(canvas, title);
    std::vector<int> positions;
    if (!is_correct) positions.push_back(step_.answered);
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
  // Captions need this width even if the pictures are narrower.
  const double min_width = 300.0 * unit;
  std::vector<Vec2> sizes;
  double max_width = 0.0;
  for (const int position : positions) {
    sizes.push_back((1.0 / context_.physical_scale->mm_per_unit) *
                    context_.shelf->size_mm(name_of(position)));
    max_width = std::max(max_width, sizes.back().x);
  }
  const double gap = std::max(64.0 * unit, min_width - max_width);
  const PictureGrid grid = lay_out_pictures(sizes, area.inset(8.0 * unit), gap, line);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Box& picture = grid.pictures[i];
    const bool is_right = positions[i] == step_.correct;
    canvas.draw_picture(*context_.shelf, name_of(positions[i]), picture);
    if (is_right) canvas.outline(picture.inset(-4.0 * unit), tone::kGood, 6.0 * unit, 6.0 * unit);
    const double width = std::max(picture.width + 40.0 * unit, min_width);
    canvas.draw_label({picture.x + (picture.width - width) / 2.0, picture.bottom() + 12.0 * unit,
                       width, line - 12.0 * unit},
                      is_right ? Letters::strong : Letters::body,
                      is_right ? tone::kGood : tone::kText,
                      is_right ? words.it_was_this : words.your_answer);
  }
}

std::optional<session::StepReply> FeedbackScreen::activate(int /*id*/, Time /*at*/) {
  return session::StepReply{};
}

}  // namespace touchtrial::app
