#include "app/windows/participant/answer_screen.hpp"

#include "app/windows/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchtrial::app {
namespace {

constexpr double kBadge = 40.0;  ///< height of the number below a picture
constexpr double kBadgeSide = 34.0;
constexpr double kWordWidth = 300.0;  ///< of a choice that is a word
constexpr double kWordHeight = 130.0;

}  // namespace

AnswerScreen::AnswerScreen(const session::AnswerStep& step, const ScreenContext& context,
                           std::vector<std::string> labels)
    : step_(step), context_(context), labels_(std::move(labels)) {}

int AnswerScreen::default_target() const noexcept {
  const bool ready = answered_at_ ? confidence_ > 0 : chosen_ >= 0;
  return ready ? kNextTarget : -1;
}

std::string AnswerScreen::hint() const {
  const Words& words = *context_.words;
  if (is_fixed()) return words.now_fixed;
  if (chosen_ >= 0) return words.changes_once;
  return with_numbers(words.choose_hint, {{"keys", std::min(count(), 9)}});
}

std::string AnswerScreen::name_of(int position) const {
  const std::string& label = labels_[static_cast<std::size_t>(position)];
  return has_words() ? choice_text(*context_.words, label) : label;
}

void AnswerScreen::paint(Canvas& canvas) {
  const Words& words = *context_.words;
  draw_progress(canvas, progress_of(words, step_.trial, step_.of, step_.practice));
  if (answered_at_) return paint_confidence(canvas);
  const bool spoken = step_.sight == study::Sight::blindfold;
  const std::string& saying = has_words() ? words.answer_spoken_choice : words.answer_spoken_text;
  const std::string note = step_.time_is_up ? words.time_is_up : (spoken ? saying : "");
  const std::string& which = spoken ? words.answer_spoken_title : words.answer_title;
  const Box area = draw_heading(canvas, has_words() ? title_of(words, title()) : which, note,
                                step_.time_is_up ? tone::kWarn : tone::kQuiet);
  if (spoken) {
    paint_names(canvas, area);
  } else if (has_words()) {
    paint_words(canvas, area);
  } else {
    paint_pictures(canvas, area);
  }
  std::vector<FooterButton> buttons;
  if (step_.may_explore_again) buttons.push_back({kFeelAgainTarget, words.feel_again, false});
  // A spoken answer needs no button.
  if (!spoken || chosen_ >= 0) buttons.push_back({kNextTarget, words.next, true, chosen_ >= 0});
  draw_footer(canvas, buttons);
}

void AnswerScreen::paint_pictures(Canvas& canvas, const Box& area) {
  const double unit = canvas.unit();
  std::vector<Vec2> sizes;
  for (const std::string& label : labels_) {
    sizes.push_back((1.0 / context_.glass->mm_per_unit) * context_.shelf->size_mm(label));
  }
  const double line = 30.0 * unit;
  Box room = area;
  room.height -= 2.0 * line;
  const PictureGrid grid =
      lay_out_pictures(sizes, room.inset(8.0 * unit), 32.0 * unit, kBadge * unit);
  for (int i = 0; i < count(); ++i) {
    paint_picture(canvas, i, grid.pictures[static_cast<std::size_t>(i)]);
  }
  canvas.label({area.x, room.bottom(), area.width, line}, Letters::small,
               is_fixed() ? tone::kText : tone::kQuiet, hint());
  draw_scale_bar(canvas, {area.x, room.bottom() + line, area.width, line}, context_, grid.shown);
}

void AnswerScreen::paint_picture(Canvas& canvas, int position, const Box& picture) {
  const double unit = canvas.unit();
  const bool chosen = chosen_ == position;
  const bool open = !is_fixed();
  canvas.picture(*context_.shelf, labels_[static_cast<std::size_t>(position)], picture);
  const Box rim = picture.inset(-4.0 * unit);
  if (chosen) {
    canvas.outline(rim, tone::kAccent, 6.0 * unit, 6.0 * unit);
  } else if (open && canvas.attention().hover == position) {
    canvas.outline(rim, tone::kAccent, 2.0 * unit, 6.0 * unit);
  }
  const double side = kBadgeSide * unit;
  const Box badge = {std::round(picture.x + (picture.width - side) / 2.0),
                     std::round(picture.bottom() + 10.0 * unit), side, side};
  paint_number(canvas, position, badge);
  if (!open) return;
  canvas.target(position, {picture.x, picture.y, picture.width, badge.bottom() - picture.y});
  canvas.focus_ring(position, rim, 8.0 * unit);
}

void AnswerScreen::paint_number(Canvas& canvas, int position, const Box& badge) const {
  const bool chosen = chosen_ == position;
  if (chosen) canvas.fill(badge, tone::kAccent, badge.width / 2.0);
  canvas.label(badge, Letters::body,
               chosen ? tone::kWhite : (is_fixed() ? tone::kQuiet : tone::kText),
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
    canvas.button(i, box, name_of(i), ButtonKind::choice, !is_fixed(), chosen_ == i);
    paint_number(
        canvas, i,
        {std::round(box.x + (width - side) / 2.0), box.bottom() + 12.0 * unit, side, side});
  }
  canvas.label({area.x, area.bottom() - line, area.width, line}, Letters::small,
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
    // Without numbers, because those of the experimenter's alphabetical list differ.
    canvas.button(i, box, name_of(i), ButtonKind::line, !is_fixed(), chosen_ == i);
  }
  if (chosen_ < 0) return;
  canvas.label({area.x, area.y + room, area.width, line}, Letters::small, tone::kQuiet, hint());
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
    canvas.button(i, {std::round(x + i * (side + gap)), y, side, side}, std::to_string(i + 1),
                  ButtonKind::choice, true, confidence_ == i + 1);
  }
  const Box line = {x, y + side + 18.0 * unit, width, 34.0 * unit};
  const double half = width / 2.0 - gap;
  canvas.label({line.x, line.y, half, line.height}, Letters::body, tone::kQuiet,
               words.confidence_least, Align::left);
  canvas.label({line.right() - half, line.y, half, line.height}, Letters::body, tone::kQuiet,
               words.confidence_most, Align::right);
  draw_footer(canvas, {{kNextTarget, words.next, true, confidence_ > 0}});
}

bool AnswerScreen::takes_key(const InputEvent& event) {
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
  if (is_fixed() || position == chosen_) return;
  if (chosen_ >= 0) first_ = chosen_;
  chosen_ = position;
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
  reply.answer = Chosen{chosen_, first_};
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
  const bool correct = step_.answered == step_.correct;
  const std::string title = correct ? words.correct_title : words.wrong_title;
  const auto* const choose = std::get_if<study::Choose>(&context_.ask.question);
  const bool has_words = choose != nullptr && choose->has_words();
  if (has_words) {
    draw_card(canvas, title,
              filled(words.right_answer, {{"label", choice_text(words, name_of(step_.correct))}}));
  } else if (context_.sight == study::Sight::blindfold) {
    draw_card(canvas, title, filled(words.it_was, {{"label", name_of(step_.correct)}}));
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
  // Captions need this width, however small the pictures are.
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
