#include "app/windows/participant/screen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace touchtrial::app {

void Screen::draw(Canvas& canvas) {
  paint(canvas);
  targets_ = canvas.targets();
}

bool Screen::has_target(int id) const noexcept {
  return std::any_of(targets_.begin(), targets_.end(),
                     [id](const Target& target) { return target.id == id; });
}

int Screen::target_at(Vec2 position) const noexcept {
  for (const Target& target : targets_) {
    if (target.box.contains(position)) return target.id;
  }
  return -1;
}

std::optional<session::StepReply> Screen::handle(const InputEvent& event) {
  if (is_done_) return std::nullopt;
  std::optional<session::StepReply> reply;
  switch (event.kind) {
    case InputEvent::Kind::key:
    case InputEvent::Kind::repeat:
    case InputEvent::Kind::letter:
      reply = handle_key(event);
      break;
    default:
      reply = handle_pointer(event);
  }
  if (reply) {
    is_done_ = true;
    reply->at = reply->at.value_or(event.at);
  }
  return reply;
}

std::optional<session::StepReply> Screen::handle_pointer(const InputEvent& event) {
  const int target_id = target_at(event.position);
  attention_.hover = target_id;
  if (event.kind == InputEvent::Kind::pressed) {
    attention_.held = target_id;
    attention_.focus = -1;
  }
  if (attention_.held >= 0) drag(attention_.held, event.position);
  if (event.kind != InputEvent::Kind::released) return std::nullopt;
  const int held_id = std::exchange(attention_.held, -1);
  if (held_id < 0 || held_id != target_id) return std::nullopt;
  return activate(target_id, event.at);
}

std::optional<session::StepReply> Screen::handle_key(const InputEvent& event) {
  if (handle_special_key(event)) return std::nullopt;
  // A key that is held down acts once.
  if (event.kind != InputEvent::Kind::key) return std::nullopt;
  switch (event.key) {
    case Key::enter:
    case Key::space: {
      const int id = has_target(attention_.focus) ? attention_.focus : default_target();
      if (id < 0 || !has_target(id)) return std::nullopt;
      return activate(id, event.at);
    }
    case Key::left:
    case Key::right:
    case Key::up:
    case Key::down:
    case Key::tab:
    case Key::back_tab:
      move_focus(event.key);
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

namespace {

Vec2 centre(const Box& box) {
  return {box.x + box.width / 2.0, box.y + box.height / 2.0};
}

/// The distance between two boxes in a direction; infinite if `other` is not in that direction.
double distance_towards(const Box& start, const Box& other, Key direction) {
  const Vec2 step = centre(other) - centre(start);
  const bool is_horizontal = direction == Key::left || direction == Key::right;
  const double sign = direction == Key::left || direction == Key::up ? -1.0 : 1.0;
  const double forwards = sign * (is_horizontal ? step.x : step.y);
  const double sideways = std::abs(is_horizontal ? step.y : step.x);
  if (forwards <= 1.0 || (is_horizontal && sideways > start.height)) {
    return std::numeric_limits<double>::infinity();
  }
  return forwards + 2.0 * sideways;
}

}  // namespace

void Screen::move_focus(Key key) {
  if (targets_.empty()) return;
  const auto current = std::find_if(targets_.begin(), targets_.end(), [this](const Target& target) {
    return target.id == attention_.focus;
  });
  const bool backwards = key == Key::back_tab || key == Key::left || key == Key::up;
  if (current == targets_.end()) {
    attention_.focus = backwards ? targets_.back().id : targets_.front().id;
    return;
  }
  if (key == Key::tab || key == Key::back_tab) {
    const auto count = targets_.size();
    const auto index = static_cast<std::size_t>(current - targets_.begin());
    attention_.focus = targets_[(index + (backwards ? count - 1 : 1)) % count].id;
    return;
  }
  double shortest = std::numeric_limits<double>::infinity();
  for (const Target& target : targets_) {
    const double distance = distance_towards(current->box, target.box, key);
    if (distance < shortest) attention_.focus = target.id;
    shortest = std::min(shortest, distance);
  }
}

}  // namespace touchtrial::app
