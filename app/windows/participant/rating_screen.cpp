#include "app/windows/participant/rating_screen.hpp"

#include "app/windows/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace touchtrial::app {
namespace {

// Targets of scales: scale i has the ids from kScaleTargets + i * kTargetsOfScale on; the first is
// its line, the n-th after it is its number n.
constexpr int kScaleTargets = 1000;
constexpr int kTargetsOfScale = 100;

// In units of the design.
constexpr double kHintHeight = 30.0;
constexpr double kBarHeight = 34.0;
constexpr double kRowHeight = 92.0;     ///< maximum height of a scale
constexpr double kMinRowHeight = 54.0;  ///< below this the picture shrinks
constexpr double kRowsWidth = 1000.0;   ///< maximum width of the scales
constexpr double kGap = 14.0;
constexpr double kTick = 12.0;
constexpr double kNumberSide = 46.0;

// Fractions.
constexpr double kColumn = 0.38;    ///< width of a picture beside the scales, of the screen's width
constexpr double kQuestion = 0.42;  ///< height of a question, of its row's height
constexpr double kEndWords = 0.2;   ///< width of the words at each end, of the row's width

// Steps of keys on a line.
constexpr int kMarkerSteps = 100;  ///< steps in the length of a line
constexpr int kStepsWithShift = 10;

/// Rounds to the steps of a line.
double rounded_to_line(double share) {
  const double steps = std::round(1.0 / study::kLineStep);
  return std::round(std::clamp(share, 0.0, 1.0) * steps) / steps;
}

int target_of(std::size_t scale, int number = 0) {
  return kScaleTargets + kTargetsOfScale * static_cast<int>(scale) + number;
}

std::size_t scale_of(int target) {
  return static_cast<std::size_t>((target - kScaleTargets) / kTargetsOfScale);
}

int number_of(int target) {
  return (target - kScaleTargets) % kTargetsOfScale;
}

}  // namespace

RatingScreen::RatingScreen(const session::AnswerStep& step, const ScreenContext& context)
    : step_(step),
      context_(context),
      scales_(std::get<study::RatingQuestion>(step.question).scales),
      ratings_(scales_.size()),
      lines_(scales_.size()) {}

bool RatingScreen::is_complete() const noexcept {
  return std::ranges::all_of(ratings_, [](const auto& rating) { return rating.has_value(); });
}

int RatingScreen::default_target() const noexcept {
  return is_complete() ? kNextTarget : -1;
}

const std::string& RatingScreen::hint() const {
  const bool has_line = std::ranges::count(scales_, 0, &study::Scale::points) > 0;
  return has_line ? context_.words->rate_hint : context_.words->rate_hint_points;
}

void RatingScreen::paint(Canvas& canvas) {
  const Words& words = *context_.words;
  const double unit = canvas.unit();
  draw_progress(canvas, progress_of(words, step_.trial, step_.total, step_.practice));
  const Box area =
      draw_heading(canvas, title_of(words, std::get<study::RatingQuestion>(step_.question).title),
                   step_.time_is_up ? words.time_is_up_rating : "", tone::kWarn);
  Box room = area;
  room.height -= kHintHeight * unit;
  const Arrangement layout = arrangement(room, unit);
  if (!step_.picture.empty()) {
    canvas.draw_picture(*context_.shelf, step_.picture, layout.picture);
    draw_scale_bar(canvas, layout.scale_bar, context_, layout.scale);
  }
  Box row = layout.rows;
  row.height /= static_cast<double>(scales_.size());
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    paint_scale(canvas, i, row);
    row.y += row.height;
  }
  canvas.draw_label({area.x, room.bottom(), area.width, kHintHeight * unit}, Letters::small,
                    tone::kQuiet, hint());
  std::vector<FooterButton> buttons;
  if (step_.may_explore_again) buttons.push_back({kFeelAgainTarget, words.feel_again, false});
  buttons.push_back({kNextTarget, words.next, true, is_complete()});
  draw_footer(canvas, buttons);
}

/// Places the scales below the picture, or to its right if the picture is then larger.
RatingScreen::Arrangement RatingScreen::arrangement(const Box& room, double unit) const {
  const auto count = static_cast<double>(scales_.size());
  Arrangement layout;
  const auto place_rows = [&](const Box& rows) {
    layout.rows = rows;
    layout.rows.width = std::min(rows.width, kRowsWidth * unit);
    layout.rows.height = std::min(rows.height, count * kRowHeight * unit);
    layout.rows.x += (rows.width - layout.rows.width) / 2.0;
    layout.rows.y += (rows.height - layout.rows.height) / 2.0;
  };
  if (step_.picture.empty()) {
    place_rows(room);
    return layout;
  }
  const Vec2 size =
      (1.0 / context_.physical_scale->mm_per_unit) * context_.shelf->size_mm(step_.picture);
  const double bar = kBarHeight * unit;
  const double gap = kGap * unit;
  const double column = kColumn * room.width;
  const auto fit = [&](double width, double height) {
    return std::clamp(std::min(width / size.x, height / size.y), 0.01, 1.0);
  };
  const double scale_below =
      fit(room.width, room.height - bar - gap - count * kMinRowHeight * unit);
  const double scale_beside = fit(column, room.height - bar);
  layout.scale = std::max(scale_below, scale_beside);
  const Vec2 picture_size = layout.scale * size;
  if (scale_beside > scale_below) {
    const double top = room.y + (room.height - picture_size.y - bar) / 2.0;
    layout.picture = {room.x + (column - picture_size.x) / 2.0, top, picture_size.x,
                      picture_size.y};
    layout.scale_bar = {room.x, layout.picture.bottom(), column, bar};
    const double left = room.x + column + 2.0 * gap;
    place_rows({left, room.y, room.right() - left, room.height});
    return layout;
  }
  const double rows = std::min(room.height - picture_size.y - bar - gap, count * kRowHeight * unit);
  const double top = room.y + (room.height - picture_size.y - bar - gap - rows) / 2.0;
  layout.picture = {room.x + (room.width - picture_size.x) / 2.0, top, picture_size.x,
                    picture_size.y};
  layout.scale_bar = {room.x, layout.picture.bottom(), room.width, bar};
  place_rows({room.x, layout.scale_bar.bottom() + gap, room.width, rows});
  return layout;
}

void RatingScreen::paint_scale(Canvas& canvas, std::size_t index, const Box& row) {
  const double unit = canvas.unit();
  const study::Scale& scale = scales_[index];
  const bool has_several_scales = scales_.size() > 1;
  const double question_height = kQuestion * row.height;
  canvas.draw_label({row.x, row.y, row.width, question_height},
                    has_several_scales ? Letters::small : Letters::body, tone::kText, scale.text);
  const Box lower = {row.x, row.y + question_height, row.width, row.height - question_height};
  const double words_width = kEndWords * row.width;
  const double gap = (kTick + 10.0) * unit;
  canvas.draw_label({lower.x, lower.y, words_width, lower.height}, Letters::small, tone::kQuiet,
                    scale.low, Align::right);
  canvas.draw_label({lower.right() - words_width, lower.y, words_width, lower.height},
                    Letters::small, tone::kQuiet, scale.high, Align::left);
  const Box middle = {lower.x + words_width + gap, lower.y, lower.width - 2.0 * (words_width + gap),
                      lower.height};
  if (has_several_scales && index == current_ && attention().focus < 0) {
    const double margin = (kTick + 4.0) * unit;
    canvas.outline({middle.x - margin, middle.y, middle.width + 2.0 * margin, middle.height},
                   tone::kAccent, 2.0 * unit, 8.0 * unit);
  }
  scale.points == 0 ? paint_line(canvas, index, middle) : paint_points(canvas, index, middle);
}

void RatingScreen::paint_line(Canvas& canvas, std::size_t index, const Box& room) {
  const double unit = canvas.unit();
  const double thickness = std::max(1.0, std::round(3.0 * unit));
  const double y = std::round(room.y + room.height / 2.0);
  const double tick = std::min(kTick * unit, room.height / 2.0 - 2.0 * unit);
  const Box line = {std::round(room.x), y - thickness / 2.0, std::round(room.width), thickness};
  canvas.fill(line, tone::kText);
  canvas.fill({line.x, y - tick, thickness, 2.0 * tick}, tone::kText);
  canvas.fill({line.right() - thickness, y - tick, thickness, 2.0 * tick}, tone::kText);
  if (const std::optional<double>& rating = ratings_[index]) {
    const double half = std::max(2.0, std::round(4.0 * unit));
    canvas.fill({line.x + *rating * line.width - half, y - tick, 2.0 * half, 2.0 * tick},
                tone::kAccent, half);
  }
  lines_[index] = line;
  canvas.add_target(target_of(index),
                    {line.x - kTick * unit, room.y, line.width + 2.0 * kTick * unit, room.height});
}

void RatingScreen::paint_points(Canvas& canvas, std::size_t index, const Box& room) {
  const double unit = canvas.unit();
  const int points = scales_[index].points;
  const double pitch = room.width / points;
  const double side = std::min({0.9 * pitch, room.height - 4.0 * unit, kNumberSide * unit});
  for (int number = 1; number <= points; ++number) {
    const int id = target_of(index, number);
    const bool is_chosen = ratings_[index] == number;
    const bool is_hovered = canvas.attention().hover == id;
    const Box box = {std::round(room.x + (number - 0.5) * pitch - side / 2.0),
                     std::round(room.y + (room.height - side) / 2.0), side, side};
    const double rounding = side / 4.0;
    canvas.fill(box, is_chosen ? tone::kAccent : (is_hovered ? tone::kAccentPale : tone::kCard),
                rounding);
    if (!is_chosen)
      canvas.outline(box, is_hovered ? tone::kAccent : tone::kEdge, 1.5 * unit, rounding);
    canvas.draw_label(box, Letters::small, is_chosen ? tone::kWhite : tone::kText,
                      std::to_string(number));
    canvas.add_target(id, box);
  }
}

void RatingScreen::drag(int id, Vec2 pointer) {
  if (id < kScaleTargets) return;
  current_ = scale_of(id);
  if (number_of(id) > 0) return;
  const Box& line = lines_[current_];
  ratings_[current_] = rounded_to_line((pointer.x - line.x) / line.width);
}

void RatingScreen::move_marker(int steps) {
  const int points = scales_[current_].points;
  std::optional<double>& rating = ratings_[current_];
  if (points == 0) {
    rating = rounded_to_line(rating ? *rating + static_cast<double>(steps) / kMarkerSteps : 0.5);
  } else {
    rating = rating ? std::clamp(*rating + (steps < 0 ? -1.0 : 1.0), 1.0, 1.0 * points)
                    : (points + 1) / 2;
  }
}

void RatingScreen::choose_number(int number) {
  if (number >= 1 && number <= scales_[current_].points) ratings_[current_] = number;
}

void RatingScreen::move_focus_by(int step, bool wraps) {
  std::vector<int> buttons;
  for (const int id : {kFeelAgainTarget, kNextTarget}) {
    if (has_target(id)) buttons.push_back(id);
  }
  const int scales = static_cast<int>(scales_.size());
  const int target_count = scales + static_cast<int>(buttons.size());
  const auto button = std::ranges::find(buttons, attention().focus);
  int position = button == buttons.end() ? static_cast<int>(current_)
                                         : scales + static_cast<int>(button - buttons.begin());
  position = wraps ? (position + step + target_count) % target_count
                   : std::clamp(position + step, 0, target_count - 1);
  if (position >= scales) return focus(buttons[static_cast<std::size_t>(position - scales)]);
  current_ = static_cast<std::size_t>(position);
  focus(-1);
}

bool RatingScreen::move_to_unrated() {
  if (!ratings_[current_] || is_complete()) return false;
  do {
    current_ = (current_ + 1) % scales_.size();
  } while (ratings_[current_]);
  return true;
}

bool RatingScreen::handle_special_key(const InputEvent& event) {
  const bool is_at_scale = attention().focus < 0;
  const int step = event.shift ? kStepsWithShift : 1;
  if (is_at_scale && (event.key == Key::left || event.key == Key::right)) {
    move_marker(event.key == Key::left ? -step : step);
    return true;
  }
  if (event.kind != InputEvent::Kind::key) return false;
  switch (event.key) {
    case Key::digit:
      if (is_at_scale) choose_number(event.digit);
      return true;
    case Key::up:
    case Key::down:
      move_focus_by(event.key == Key::up ? -1 : 1, false);
      return true;
    case Key::tab:
    case Key::back_tab:
      move_focus_by(event.key == Key::back_tab ? -1 : 1, true);
      return true;
    case Key::enter:
    case Key::space:
      return is_at_scale && move_to_unrated();
    default:
      return false;
  }
}

std::optional<session::StepReply> RatingScreen::activate(int id, Time at) {
  if (id >= kScaleTargets) {
    choose_number(number_of(id));
    return std::nullopt;
  }
  session::StepReply reply;
  if (id == kFeelAgainTarget) {
    reply.explore_again = true;
    return reply;
  }
  RatingAnswer ratings;
  for (const std::optional<double>& rating : ratings_) ratings.values.push_back(rating.value());
  reply.at = at;
  reply.answer = std::move(ratings);
  return reply;
}

}  // namespace touchtrial::app
