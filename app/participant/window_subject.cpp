#include "app/participant/window_subject.hpp"

#include "app/participant/screen.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace touchtrial::app {
WindowSubject::WindowSubject(ParticipantWindow& window, session::Participant& subject,
                             bool real_time)
    : window_(window), subject_(subject), real_time_(real_time) {}

void WindowSubject::see_pictures(const std::vector<std::string>& labels) {
  window_.see_pictures(labels);
  subject_.see_pictures(labels);
}

std::optional<session::StepReply> WindowSubject::attend(const session::Step& step) {
  std::optional<session::StepReply> reply = window_.attend(step);
  const auto* const notice = std::get_if<session::NoticeStep>(&step);
  const bool goes_on_by_itself =
      std::holds_alternative<session::PauseStep>(step) || (notice != nullptr && !notice->may_go_on);
  if (goes_on_by_itself) return std::nullopt;
  // What was typed for a step that was broken off is no reply to this one.
  if (!step_ || !is_same_step(*step_, step)) forget();
  step_ = step;
  if (!reply && !meant_) meant_ = subject_.attend(step);
  // Nothing is typed between intervals, and no time passes there unless it is real.
  const bool is_between = std::holds_alternative<session::IntervalStep>(step);
  if (is_between && !real_time_ && !reply) reply = meant_;
  constexpr std::chrono::milliseconds kShownLimit{1000};
  if (!is_between && !reply && meant_ && !typed_ && window_.wait_until_shown(kShownLimit)) {
    type(step, *meant_);
    typed_ = true;
    reply = window_.attend(step);
  }
  if (!reply) return std::nullopt;
  if (!real_time_) {
    reply->at.reset();
    reply->took = meant_ ? meant_->took : std::chrono::nanoseconds{};
  }
  forget();
  return reply;
}

device::HapticDevice& WindowSubject::begin_exploring(const PlaneGeometry& plane) {
  forget();
  window_.show_exploring(plane);
  return subject_.begin_exploring(plane);
}

void WindowSubject::exploring(device::ServoControl& servo) {
  subject_.exploring(servo);
  window_.exploring(servo);
}

void WindowSubject::feel(const device::ServoSample& sample) noexcept {
  subject_.feel(sample);
  window_.feel(sample);
}

void WindowSubject::forget() {
  meant_.reset();
  typed_ = false;
}

void WindowSubject::press(Key key, int digit) {
  InputEvent event;
  event.at = std::chrono::steady_clock::now();
  event.key = key;
  event.digit = digit;
  window_.inject(event);
}

void WindowSubject::type(const session::Step& step, const session::StepReply& reply) {
  if (const auto* const pages = std::get_if<session::InstructionStep>(&step)) {
    for (std::size_t i = 0; i < pages->pages.size(); ++i) press(Key::enter);
    if (pages->pages.empty()) press(Key::enter);
    return;
  }
  if (const auto* const asked = std::get_if<session::QuestionStep>(&step)) {
    for (const design::Question& question : asked->questionnaire->questions) {
      // A required question gets the first option, or the smallest number, or a 1.
      if (question.required && question.kind == design::QuestionKind::choice) press(Key::digit, 1);
      if (question.required && question.kind != design::QuestionKind::choice) {
        const double most = question.max.value_or(1.0);
        for (const char digit : number_text(question.min.value_or(std::min(most, 1.0)))) {
          InputEvent event;
          event.kind = InputEvent::Kind::letter;
          event.at = std::chrono::steady_clock::now();
          event.letter = static_cast<unsigned char>(digit);
          window_.inject(event);
        }
      }
      press(Key::enter);
    }
    if (asked->questionnaire->questions.empty()) press(Key::enter);
    return;
  }
  if (const auto* const answer = std::get_if<session::AnswerStep>(&step)) {
    if (reply.first_position) press(Key::digit, *reply.first_position + 1);
    press(Key::digit, reply.position + 1);
    press(Key::enter);
    if (answer->confidence_levels == 0) return;
    press(Key::digit, reply.confidence.value_or(1));
    press(Key::enter);
    return;
  }
  press(Key::enter);
}

}  // namespace touchtrial::app
