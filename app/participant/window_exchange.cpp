#include "app/participant/window_exchange.hpp"

#include <utility>

namespace touchtrial::app {

void WindowExchange::show(std::shared_ptr<Screen> screen) {
  const std::lock_guard lock(mutex_);
  screen_ = std::move(screen);
  reply_.reset();
  replied_by_.reset();
  // A screen that returns must be drawn again before it counts as shown.
  shown_.reset();
  dirty_ = true;
  for_drawing_.notify_all();
}

std::optional<session::StepReply> WindowExchange::reply(const Screen& of,
                                                        std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  for_others_.wait_for(lock, longest, [&] { return replied_by_.get() == &of || failure_; });
  if (replied_by_.get() != &of) return std::nullopt;
  replied_by_.reset();
  return std::exchange(reply_, std::nullopt);
}

void WindowExchange::push(const InputEvent& event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(event);
  settled_ = false;
  for_drawing_.notify_all();
}

void WindowExchange::set_surface(const WindowSurface& surface) {
  const std::lock_guard lock(mutex_);
  surface_ = surface;
  dirty_ = true;
  for_drawing_.notify_all();
}

void WindowExchange::redraw() {
  const std::lock_guard lock(mutex_);
  dirty_ = true;
  for_drawing_.notify_all();
}

void WindowExchange::end() {
  const std::lock_guard lock(mutex_);
  ending_ = true;
  for_drawing_.notify_all();
  for_others_.notify_all();
}

WindowExchange::Work WindowExchange::wait_for_work(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  const auto is_new = [this] { return dirty_ || ending_ || picture_wanted_ || !events_.empty(); };
  for_drawing_.wait_for(lock, longest, [&] { return stirred_ || is_new(); });
  const bool came = is_new();
  stirred_ = false;
  dirty_ = false;
  return {screen_, surface_, std::exchange(events_, {}), picture_wanted_, ending_, came};
}

void WindowExchange::stir() {
  const std::lock_guard lock(mutex_);
  stirred_ = true;
  for_drawing_.notify_all();
}

void WindowExchange::shown(const std::shared_ptr<Screen>& screen, bool events_left) {
  const std::lock_guard lock(mutex_);
  shown_ = screen;
  settled_ = !events_left && events_.empty();
  for_others_.notify_all();
}

void WindowExchange::replied(const std::shared_ptr<Screen>& screen,
                             const session::StepReply& reply) {
  const std::lock_guard lock(mutex_);
  if (screen != screen_) return;  // the session has moved on
  replied_by_ = screen;
  reply_ = reply;
  for_others_.notify_all();
}

void WindowExchange::keep(engine::ColourImage picture) {
  const std::lock_guard lock(mutex_);
  picture_ = std::move(picture);
  picture_wanted_ = false;
  for_others_.notify_all();
}

void WindowExchange::failed(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  failure_ = std::move(failure);
  for_others_.notify_all();
}

WindowSurface WindowExchange::surface() const {
  const std::lock_guard lock(mutex_);
  return surface_;
}

bool WindowExchange::wait_until_shown(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  return for_others_.wait_for(lock, longest,
                              [this] { return shown_ == screen_ && settled_ && events_.empty(); });
}

std::optional<engine::ColourImage> WindowExchange::picture(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  picture_.reset();
  picture_wanted_ = true;
  for_drawing_.notify_all();
  for_others_.wait_for(lock, longest, [this] { return picture_.has_value() || failure_; });
  return std::exchange(picture_, std::nullopt);
}

void WindowExchange::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace touchtrial::app
