#include "app/windows/participant/rating_screen.hpp"

#include "app/windows/participant/page_layout.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace touchtrial::app {
namespace {

// Target numbers of scales: a line has the first of its scale's range, a number n the one n places
// later.
constexpr int kScaleTargets = 1000;
constexpr int kTargetsOfScale = 100;

// In units of the design.
constexpr double kHintHeight = 30.0;
constexpr double kBarHeight = 34.0;
constexpr double kRowHeight = 92.0;     ///< of a scale, at most
constexpr double kMinRowHeight = 54.0;  ///< below this the picture shrinks
constexpr double kRowsWidth = 1000.0;   ///< at most
constexpr double kGap = 14.0;
constexpr double kTick = 12.0;
constexpr double kNumberSide = 46.0;

// As shares.
constexpr double kColumn = 0.38;    ///< of a picture beside the scales, of the width
constexpr double kQuestion = 0.42;  ///< of a row's height
constexpr double kEndWords = 0.2;   ///< of a row's width, at each end

// Steps of keys on a line.
constexpr int kMarkerSteps = 100;  ///< in its length
constexpr int kStepsWithShift = 10;

/// Rounds to the steps of a line.
double on_line(double share) {
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
      scales_(std::get<study::Rate>(step.question).scales),
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
  draw_progress(canvas, progress_of(words, step_.trial, step_.of, step_.practice));
  const Box area =
      draw_heading(canvas, title_of(words, std::get<study::Rate>(step_.question).title),
                   step_.time_is_up ? words.time_is_up_rating : "", tone::kWarn);
  Box room = area;
  room.height -= kHintHeight * unit;
  const Arrangement at = arranged(room, unit);
  if (!step_.picture.empty()) {
    canvas.picture(*context_.shelf, step_.picture, at.picture);
    draw_scale_bar(canvas, at.scale_bar, context_, at.shown);
  }
  Box row = at.rows;
  row.height /= static_cast<double>(scales_.size());
  for (std::size_t i = 0; i < scales_.size(); ++i) {
    paint_scale(canvas, i, row);
    row.y += row.height;
  }
  canvas.label({area.x, room.bottom(), area.width, kHintHeight * unit}, Letters::small,
               tone::kQuiet, hint());
  std::vector<FooterButton> buttons;
  if (step_.may_explore_again) buttons.push_back({kFeelAgainTarget, words.feel_again, false});
  buttons.push_back({kNextTarget, words.next, true, is_complete()});
  draw_footer(canvas, buttons);
}

/// Places the scales below the picture, or to its right if the picture is then larger.
RatingScreen::Arrangement RatingScreen::arranged(const Box& room, double unit) const {
  const auto count = static_cast<double>(scales_.size());
  Arrangement at;
  const auto place_rows = [&](const Box& rows) {
    at.rows = rows;
    at.rows.width = std::min(rows.width, kRowsWidth * unit);
    at.rows.height = std::min(rows.height, count * kRowHeight * unit);
    at.rows.x += (rows.width - at.rows.width) / 2.0;
    at.rows.y += (rows.height - at.rows.height) / 2.0;
  };
  if (step_.picture.empty()) {
    place_rows(room);
    return at;
  }
  const Vec2 size = (1.0 / context_.glass->mm_per_unit) * context_.shelf->size_mm(step_.picture);
  const double bar = kBarHeight * unit;
  const double gap = kGap * unit;
  const double column = kColumn * room.width;
  const auto fit = [&](double width, double height) {
    return std::clamp(std::min(width / size.x, height / size.y), 0.01, 1.0);
  };
  const double below = fit(room.width, room.height - bar - gap - count * kMinRowHeight * unit);
  const double beside = fit(column, room.height - bar);
  at.shown = std::max(below, beside);
  const Vec2 drawn = at.shown * size;
  if (beside > below) {
    const double top = room.y + (room.height - drawn.y - bar) / 2.0;
    at.picture = {room.x + (column - drawn.x) / 2.0, top, drawn.x, drawn.y};
    at.scale_bar = {room.x, at.picture.bottom(), column, bar};
    const double left = room.x + column + 2.0 * gap;
    place_rows({left, room.y, room.right() - left, room.height});
    return at;
  }
  const double rows = std::min(room.height - drawn.y - bar - gap, count * kRowHeight * unit);
  const double top = room.y + (room.height - drawn.y - bar - gap - rows) / 2.0;
  at.picture = {room.x + (room.width - drawn.x) / 2.0, top, drawn.x, drawn.y};
  at.scale_bar = {room.x, at.picture.bottom(), room.width, bar};
  place_rows({room.x, at.scale_bar.bottom() + gap, room.width, rows});
  return at;
}

void RatingScreen::paint_scale(Canvas& canvas, std::size_t index, const Box& row) {
  const double unit = canvas.unit();
  const study::Scale& scale = scales_[index];
  const bool is_one_of_several = scales_.size() > 1;
  const double above = kQuestion * row.height;
  canvas.label({row.x, row.y, row.width, above}, is_one_of_several ? Letters::small : Letters::body,
               tone::kText, scale.text);
  const Box below = {row.x, row.y + above, row.width, row.height - above};
  const double words = kEndWords * row.width;
  const double gap = (kTick + 10.0) * unit;
  canvas.label({below.x, below.y, words, below.height}, Letters::small, tone::kQuiet, scale.low,
               Align::right);
  canvas.label({below.right() - words, below.y, words, below.height}, Letters::small, tone::kQuiet,
               scale.high, Align::left);
  const Box middle = {below.x + words + gap, below.y, below.width - 2.0 * (words + gap),
                      below.height};
  if (is_one_of_several && index == current_ && attention().focus < 0) {
    const double aside = (kTick + 4.0) * unit;
    canvas.outline({middle.x - aside, middle.y, middle.width + 2.0 * aside, middle.height},
                   tone::kAccent, 2.0 * unit, 8.0 * unit);
  }
  scale.points == 0 ? paint_line(canvas, index, middle) : paint_points(canvas, index, middle);
}

void RatingScreen::paint_line(Canvas& canvas, std::size_t index, const Box& room) {
  const double unit = canvas.unit();
  const double thick = std::max(1.0, std::round(3.0 * unit));
  const double y = std::round(room.y + room.height / 2.0);
  const double tick = std::min(kTick * unit, room.height / 2.0 - 2.0 * unit);
  const Box line = {std::round(room.x), y - thick / 2.0, std::round(room.width), thick};
  canvas.fill(line, tone::kText);
  canvas.fill({line.x, y - tick, thick, 2.0 * tick}, tone::kText);
  canvas.fill({line.right() - thick, y - tick, thick, 2.0 * tick}, tone::kText);
  if (const std::optional<double>& rating = ratings_[index]) {
    const double half = std::max(2.0, std::round(4.0 * unit));
    canvas.fill({line.x + *rating * line.width - half, y - tick, 2.0 * half, 2.0 * tick},
                tone::kAccent, half);
  }
  lines_[index] = line;
  canvas.target(target_of(index),
                {line.x - kTick * unit, room.y, line.width + 2.0 * kTick * unit, room.height});
}

void RatingScreen::paint_points(Canvas& canvas, std::size_t index, const Box& room) {
  const double unit = canvas.unit();
  const int points = scales_[index].points;
  const double each = room.width / points;
  const double side = std::min({0.9 * each, room.height - 4.0 * unit, kNumberSide * unit});
  for (int number = 1; number <= points; ++number) {
    const int id = target_of(index, number);
    const bool chosen = ratings_[index] == number;
    const bool lit = canvas.attention().hover == id;
    const Box box = {std::round(room.x + (number - 0.5) * each - side / 2.0),
                     std::round(room.y + (room.height - side) / 2.0), side, side};
    const double rounding = side / 4.0;
    canvas.fill(box, chosen ? tone::kAccent : (lit ? tone::kAccentPale : tone::kCard), rounding);
    if (!chosen) canvas.outline(box, lit ? tone::kAccent : tone::kEdge, 1.5 * unit, rounding);
    canvas.label(box, Letters::small, chosen ? tone::kWhite : tone::kText, std::to_string(number));
    canvas.target(id, box);
  }
}

void RatingScreen::drag(int id, Vec2 to) {
  if (id < kScaleTargets) return;
  current_ = scale_of(id);
  if (number_of(id) > 0) return;
  const Box& line = lines_[current_];
  ratings_[current_] = on_line((to.x - line.x) / line.width);
}

void RatingScreen::move_marker(int steps) {
  const int points = scales_[current_].points;
  std::optional<double>& rating = ratings_[current_];
  if (points == 0) {
    rating = on_line(rating ? *rating + static_cast<double>(steps) / kMarkerSteps : 0.5);
  } else {
    rating = rating ? std::clamp(*rating + (steps < 0 ? -1.0 : 1.0), 1.0, 1.0 * points)
                    : (points + 1) / 2;
  }
}

void RatingScreen::choose_number(int number) {
  if (number >= 1 && number <= scales_[current_].points) ratings_[current_] = number;
}

void RatingScreen::move_keys(int by, bool around) {
  std::vector<int> buttons;
  for (const int id : {kFeelAgainTarget, kNextTarget}) {
    if (has_target(id)) buttons.push_back(id);
  }
  const int scales = static_cast<int>(scales_.size());
  const int all = scales + static_cast<int>(buttons.size());
  const auto button = std::ranges::find(buttons, attention().focus);
  int at = button == buttons.end() ? static_cast<int>(current_)
                                   : scales + static_cast<int>(button - buttons.begin());
  at = around ? (at + by + all) % all : std::clamp(at + by, 0, all - 1);
  if (at >= scales) return focus(buttons[static_cast<std::size_t>(at - scales)]);
  current_ = static_cast<std::size_t>(at);
  focus(-1);
}

bool RatingScreen::moves_on() {
  if (!ratings_[current_] || is_complete()) return false;
  do {
    current_ = (current_ + 1) % scales_.size();
  } while (ratings_[current_]);
  return true;
}

bool RatingScreen::takes_key(const InputEvent& event) {
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
      move_keys(event.key == Key::up ? -1 : 1, false);
      return true;
    case Key::tab:
    case Key::back_tab:
      move_keys(event.key == Key::back_tab ? -1 : 1, true);
      return true;
    case Key::enter:
    case Key::space:
      return is_at_scale && moves_on();
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
  Rated rated;
  for (const std::optional<double>& rating : ratings_) rated.values.push_back(rating.value());
  reply.at = at;
  reply.answer = std::move(rated);
  return reply;
}

}  // namespace touchtrial::app
