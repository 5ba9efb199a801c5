#include "app/experimenter/console_experimenter.hpp"

#include "app/experimenter/status_words.hpp"

#include <utility>

namespace touchtrial::app {

void ConsoleExperimenter::show(const session::SessionStatus& status) {
  inner_.show(status);
  const std::lock_guard lock(mutex_);
  status_ = status;
  std::string words = status_line(status);
  if (words == words_) return;
  words_ = std::move(words);
  if (listener_) listener_();
}

std::optional<session::ExperimenterRequest> ConsoleExperimenter::request() {
  {
    const std::lock_guard lock(mutex_);
    if (!added_.empty()) {
      session::ExperimenterRequest first = std::move(added_.front());
      added_.pop_front();
      return first;
    }
  }
  return inner_.request();
}

void ConsoleExperimenter::add(const session::ExperimenterRequest& request) {
  const std::lock_guard lock(mutex_);
  added_.push_back(request);
}

session::SessionStatus ConsoleExperimenter::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void ConsoleExperimenter::on_change(std::function<void()> listener) {
  const std::lock_guard lock(mutex_);
  listener_ = std::move(listener);
}

}  // namespace touchtrial::app
