#include "app/windows/experimenter/experimenter_desk.hpp"

#include "core/text.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

using RequestKind = session::ExperimenterRequest::Kind;
using Question = ExperimenterQuestion;

constexpr std::size_t kMaxShownRequests = 6;
constexpr const char* kPaused = "paused";
constexpr const char* kDone = "done";
constexpr const char* kSkip = "skip";
constexpr const char* kBack = "back";
constexpr const char* kYes = "yes";

std::string words_of(const session::ExperimenterRequest& request) {
  const std::string text = request.text.empty() ? "" : ": " + request.text;
  switch (request.kind) {
    case RequestKind::pause:
      return "pause";
    case RequestKind::resume:
      return "resume";
    case RequestKind::comfort_stop:
      return "comfort stop";
    case RequestKind::note:
      return "note" + text;
    case RequestKind::deviation:
      return "deviation " + request.code + text;
    case RequestKind::abort:
      return "end of the session" + text;
    case RequestKind::delay:
    case RequestKind::leave:
      break;
  }
  return "";
}

bool is_code_prefix(const std::string& code) {
  return !study::is_deviation_code(code) &&
         std::ranges::any_of(study::kDeviationCodes, [&](std::string_view full_code) {
           return full_code.starts_with(code);
         });
}

}  // namespace

void ExperimenterDesk::add_face(ExperimenterFace& face) {
  const std::lock_guard lock(faces_mutex_);
  faces_.push_back(&face);
}

void ExperimenterDesk::remove_face(ExperimenterFace& face) {
  const std::lock_guard lock(faces_mutex_);
  std::erase(faces_, &face);
}

void ExperimenterDesk::for_each_face(const std::function<void(ExperimenterFace&)>& work) {
  const std::lock_guard lock(faces_mutex_);
  for (ExperimenterFace* const face : faces_) work(*face);
}

void ExperimenterDesk::update_faces() {
  for_each_face([current = view()](ExperimenterFace& face) { face.show(current); });
}

ExperimenterView ExperimenterDesk::view() const {
  const std::lock_guard lock(mutex_);
  ExperimenterView current{status_, question(), question_number_, "", shown_requests_, {}};
  if (is_device_waiting_) {
    current.need = need_.empty() ? "ready: switch the force on (g) once the hand is at the pen"
                                 : "the device waits: " + need_;
  }
  for (const ExperimenterAction& action : kExperimenterActions) {
    current.allowed[static_cast<std::size_t>(action.kind)] = is_allowed(action.kind);
  }
  return current;
}

bool ExperimenterDesk::is_allowed(Action action) const {
  const bool is_paused = is_pause_requested_ || status_.stage == kPaused;
  switch (action) {
    case Action::pause:
      return !is_paused;
    case Action::resume:
      return is_paused;
    case Action::arm:
      return is_ready_shown_;
    case Action::at_reset:
      return is_device_waiting_ && !need_.empty();
    default:
      return true;
  }
}

void ExperimenterDesk::act(Action action) {
  const std::lock_guard lock(mutex_);
  if (!is_allowed(action)) return;
  switch (action) {
    case Action::pause:
      is_pause_requested_ = true;
      add_request(RequestKind::pause);
      return open(ActionQuestion::pause_reason);
    case Action::resume:
      is_pause_requested_ = false;
      return add_request(RequestKind::resume);
    case Action::comfort_stop:
      add_request(RequestKind::comfort_stop);
      return open(ActionQuestion::stop_reason);
    case Action::note:
      return open(ActionQuestion::note);
    case Action::deviation:
      code_.clear();
      return open(ActionQuestion::code);
    case Action::abort:
      return open(ActionQuestion::confirm);
    case Action::arm:
      is_armed_ = true;
      return;
    case Action::at_reset:
      is_at_reset_ = true;
      return;
  }
}

void ExperimenterDesk::open(ActionQuestion question) {
  action_question_ = question;
  ++question_number_;
}

void ExperimenterDesk::discard() {
  const std::lock_guard lock(mutex_);
  open(ActionQuestion::none);
}

void ExperimenterDesk::add_request(Request::Kind kind, const std::string& text,
                                   const std::string& code) {
  requests_.push_back({kind, text, code});
  shown_requests_.push_front(words_of(requests_.back()));
  if (shown_requests_.size() > kMaxShownRequests) shown_requests_.pop_back();
}

void ExperimenterDesk::add(const session::ExperimenterRequest& request) {
  const std::lock_guard lock(mutex_);
  requests_.push_back(request);
}

ExperimenterQuestion ExperimenterDesk::action_question() const {
  switch (action_question_) {
    case ActionQuestion::pause_reason:
      return {Question::Kind::text, "Paused. The reason, if it should be recorded"};
    case ActionQuestion::stop_reason:
      return {Question::Kind::text, "Stopped. The reason, without mentioning the texture"};
    case ActionQuestion::note:
      return {Question::Kind::text, "Note"};
    case ActionQuestion::code: {
      Question code{Question::Kind::text,
                    code_.empty() ? "Code of the deviation"
                                  : fmt::format("'{}' is only the beginning of a code", code_)};
      for (const std::string_view full_code : study::kDeviationCodes) {
        code.choices.push_back({std::string(full_code)});
      }
      return code;
    }
    case ActionQuestion::remark:
      return {Question::Kind::text, "Deviation " + code_ + ", in words"};
    case ActionQuestion::confirm:
      return {Question::Kind::confirm,
              "Abort ends this session permanently; it cannot be resumed",
              {{kYes, "End the session"}}};
    case ActionQuestion::abort_reason:
      return {Question::Kind::text, "The session ends. The reason"};
    case ActionQuestion::none:
      break;
  }
  return {};
}

ExperimenterQuestion ExperimenterDesk::question() const {
  if (action_question_ != ActionQuestion::none) return action_question();
  if (spoken_ && spoken_->is_confirmed) {
    Question confidence{Question::Kind::number,
                        fmt::format("trial {}: confidence", spoken_->step.trial)};
    for (int i = 1; i <= spoken_->step.confidence_levels; ++i) {
      confidence.choices.push_back({std::to_string(i)});
    }
    return confidence;
  }
  if (spoken_) {
    Question label{Question::Kind::number, fmt::format("trial {}:", spoken_->step.trial)};
    if (spoken_->label) {
      label.text += " " + spoken_->labels[*spoken_->label];
      label.choices.push_back({"", "Confirm"});
    }
    for (std::size_t i = 0; i < spoken_->labels.size() && !spoken_->first; ++i) {
      label.choices.push_back({std::to_string(i + 1), spoken_->labels[i]});
    }
    return label;
  }
  if (!sheet_ || sheet_->ticks.size() == sheet_->items.size()) return {};
  const session::DaySheetItem& item = sheet_->items[sheet_->ticks.size()];
  return {Question::Kind::keys,
          fmt::format("{}/{} {}", sheet_->ticks.size() + 1, sheet_->items.size(), item.text),
          {{kDone, "Done", '\n'}, {kSkip, "Skip (" + item.code + ")", 's'}, {kBack, "Back", 'b'}}};
}

void ExperimenterDesk::answer(const std::string& text) {
  const std::lock_guard lock(mutex_);
  ++question_number_;
  if (action_question_ != ActionQuestion::none) {
    answer_action_question(text);
  } else if (spoken_) {
    answer_spoken(text);
  } else if (sheet_) {
    answer_sheet(text);
  }
}

void ExperimenterDesk::answer_action_question(const std::string& text) {
  switch (std::exchange(action_question_, ActionQuestion::none)) {
    case ActionQuestion::pause_reason:
      if (!text.empty()) add_request(RequestKind::note, "pause: " + text);
      break;
    case ActionQuestion::stop_reason:
      if (!text.empty()) add_request(RequestKind::deviation, text, session::kComfortStopCode);
      break;
    case ActionQuestion::note:
      if (!text.empty()) add_request(RequestKind::note, text);
      break;
    case ActionQuestion::code:
      code_ = text;
      if (!text.empty()) open(is_code_prefix(text) ? ActionQuestion::code : ActionQuestion::remark);
      break;
    case ActionQuestion::remark:
      add_request(RequestKind::deviation, text, code_);
      break;
    case ActionQuestion::confirm:
      if (text == kYes) open(ActionQuestion::abort_reason);
      break;
    case ActionQuestion::abort_reason:
      add_request(RequestKind::abort, text);
      break;
    case ActionQuestion::none:
      break;
  }
}

void ExperimenterDesk::answer_sheet(const std::string& text) {
  auto& ticks = sheet_->ticks;
  if (text == kBack && !ticks.empty()) ticks.pop_back();
  if (ticks.size() == sheet_->items.size()) return;
  if (text == kDone) ticks.push_back(session::Tick::done);
  if (text == kSkip) ticks.push_back(session::Tick::skipped);
}

/// A label may be changed once before it is confirmed.
void ExperimenterDesk::answer_spoken(const std::string& text) {
  Spoken& spoken = *spoken_;
  const int number = number_in<int>(text).value_or(0);
  if (spoken.is_confirmed) {
    if (number >= 1 && number <= spoken.step.confidence_levels) spoken.confidence = number;
  } else if (number >= 1 && number <= static_cast<int>(spoken.labels.size())) {
    const auto label = static_cast<std::size_t>(number - 1);
    if (spoken.label == label || spoken.first) return;
    spoken.first = std::exchange(spoken.label, label);
  } else if (text.empty() && spoken.label) {
    spoken.is_confirmed = true;
  }
}

void ExperimenterDesk::show(const session::SessionStatus& status) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.stage == kPaused && status.stage != kPaused) is_pause_requested_ = false;
    status_ = status;
  }
  update_faces();
}

void ExperimenterDesk::acknowledged(int /*trial*/) {
  for_each_face([](ExperimenterFace& face) { face.clear_line(); });
}

std::optional<session::ExperimenterRequest> ExperimenterDesk::request() {
  for_each_face([](ExperimenterFace& face) { face.read_input(); });
  const std::lock_guard lock(mutex_);
  if (requests_.empty()) return std::nullopt;
  // The experimenter must see "ready" again before switching on the force.
  is_ready_shown_ = false;
  is_armed_ = false;
  Request first = std::move(requests_.front());
  requests_.pop_front();
  return first;
}

std::optional<std::vector<session::Tick>> ExperimenterDesk::day_sheet(
    const std::vector<session::DaySheetItem>& items) {
  if (!is_attended_) return std::vector<session::Tick>{};
  {
    const std::lock_guard lock(mutex_);
    if (!sheet_) sheet_.emplace(Sheet{items, {}});
  }
  for_each_face([](ExperimenterFace& face) { face.read_input(); });
  {
    const std::lock_guard lock(mutex_);
    if (sheet_->ticks.size() == items.size()) {
      return std::exchange(sheet_, std::nullopt)->ticks;
    }
  }
  update_faces();
  for_each_face([](ExperimenterFace& face) { face.sleep_briefly(); });
  return std::nullopt;
}

session::Attendant::Reply ExperimenterDesk::poll(const std::string& need) {
  forget_spoken_answer();  // because an interrupted trial's question would hide the request
  for_each_face([](ExperimenterFace& face) { face.read_input(); });
  Reply reply{};
  {
    const std::lock_guard lock(mutex_);
    reply = current_reply(need.empty());
    is_device_waiting_ = reply == Reply::wait;
    need_ = need;
    is_ready_shown_ = is_device_waiting_ && need.empty();
    is_armed_ = false;
    is_at_reset_ = false;
  }
  if (reply != Reply::wait) return reply;
  update_faces();
  for_each_face([](ExperimenterFace& face) { face.sleep_briefly(); });
  return reply;
}

/// An abort stays queued, so that the session records it and its reason when it polls.
session::Attendant::Reply ExperimenterDesk::current_reply(bool is_ready) const {
  if (std::ranges::find(requests_, RequestKind::abort, &Request::kind) != requests_.end()) {
    return Reply::stop;
  }
  if (is_ready) return is_armed_ ? Reply::arm : Reply::wait;
  return is_at_reset_ ? Reply::at_reset : Reply::wait;
}

void ExperimenterDesk::forget_spoken_answer() {
  const std::lock_guard lock(mutex_);
  spoken_.reset();
}

std::optional<SpokenAnswer> ExperimenterDesk::spoken_answer(
    const session::AnswerStep& step, const std::vector<std::string>& labels) {
  {
    const std::lock_guard lock(mutex_);
    if (!spoken_) spoken_ = Spoken{.step = step, .labels = labels};
  }
  for_each_face([](ExperimenterFace& face) { face.read_input(); });
  {
    const std::lock_guard lock(mutex_);
    const bool is_complete =
        spoken_->is_confirmed && (spoken_->confidence || step.confidence_levels == 0);
    if (is_complete) {
      const SpokenAnswer answer{*spoken_->label, spoken_->first, spoken_->confidence};
      spoken_.reset();
      return answer;
    }
  }
  update_faces();
  return std::nullopt;
}

void SpokenAnswers::see_pictures(const std::vector<std::string>& labels) {
  participant_.see_pictures(labels);
  positions_.resize(labels.size());
  std::iota(positions_.begin(), positions_.end(), 0);
  std::ranges::sort(positions_, {}, [&](int i) { return labels[static_cast<std::size_t>(i)]; });
  sorted_labels_.clear();
  for (const int i : positions_) sorted_labels_.push_back(labels[static_cast<std::size_t>(i)]);
}

std::optional<session::StepReply> SpokenAnswers::show_step(const session::Step& step) {
  const auto window_reply = participant_.show_step(step);
  const auto* answer = std::get_if<session::AnswerStep>(&step);
  if (answer == nullptr || answer->sight != study::Sight::blindfold) return window_reply;
  if (window_reply && window_reply->explore_again) return window_reply;
  const auto spoken = desk_.spoken_answer(*answer, sorted_labels_);
  if (!spoken) return std::nullopt;
  session::StepReply reply;
  reply.at = std::chrono::steady_clock::now();
  ChoiceAnswer choice{positions_.at(spoken->label)};
  if (spoken->first) choice.first_position = positions_.at(*spoken->first);
  reply.answer = choice;
  reply.confidence = spoken->confidence;
  return reply;
}

}  // namespace touchtrial::app
