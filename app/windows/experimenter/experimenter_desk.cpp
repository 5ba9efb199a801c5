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

constexpr std::size_t kAskedShown = 6;
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

bool is_half_typed(const std::string& code) {
  return !study::is_deviation_code(code) &&
         std::ranges::any_of(study::kDeviationCodes,
                             [&](std::string_view one) { return one.starts_with(code); });
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

void ExperimenterDesk::each_face(const std::function<void(ExperimenterFace&)>& work) {
  const std::lock_guard lock(faces_mutex_);
  for (ExperimenterFace* const face : faces_) work(*face);
}

void ExperimenterDesk::show_faces() {
  each_face([now = view()](ExperimenterFace& face) { face.show(now); });
}

ExperimenterView ExperimenterDesk::view() const {
  const std::lock_guard lock(mutex_);
  ExperimenterView now{status_, question(), questions_, "", asked_, {}};
  if (waits_) {
    now.need = need_.empty() ? "ready: switch the force on (g) once the hand is at the pen"
                             : "the device waits: " + need_;
  }
  for (const ExperimenterAction& action : kExperimenterActions) {
    now.may[static_cast<std::size_t>(action.what)] = may(action.what);
  }
  return now;
}

bool ExperimenterDesk::may(What what) const {
  const bool is_paused = is_pause_asked_ || status_.stage == kPaused;
  switch (what) {
    case What::pause:
      return !is_paused;
    case What::resume:
      return is_paused;
    case What::arm:
      return is_ready_shown_;
    case What::at_reset:
      return waits_ && !need_.empty();
    default:
      return true;
  }
}

void ExperimenterDesk::act(What what) {
  const std::lock_guard lock(mutex_);
  if (!may(what)) return;
  switch (what) {
    case What::pause:
      is_pause_asked_ = true;
      ask(RequestKind::pause);
      return begin(Own::pause_reason);
    case What::resume:
      is_pause_asked_ = false;
      return ask(RequestKind::resume);
    case What::comfort_stop:
      ask(RequestKind::comfort_stop);
      return begin(Own::stop_reason);
    case What::note:
      return begin(Own::note);
    case What::deviation:
      code_.clear();
      return begin(Own::code);
    case What::abort:
      return begin(Own::sure);
    case What::arm:
      is_armed_ = true;
      return;
    case What::at_reset:
      is_at_reset_ = true;
      return;
  }
}

void ExperimenterDesk::begin(Own own) {
  own_ = own;
  ++questions_;
}

void ExperimenterDesk::discard() {
  const std::lock_guard lock(mutex_);
  begin(Own::none);
}

void ExperimenterDesk::ask(Request::Kind kind, const std::string& text, const std::string& code) {
  requests_.push_back({kind, text, code});
  asked_.push_front(words_of(requests_.back()));
  if (asked_.size() > kAskedShown) asked_.pop_back();
}

void ExperimenterDesk::add(const session::ExperimenterRequest& request) {
  const std::lock_guard lock(mutex_);
  requests_.push_back(request);
}

ExperimenterQuestion ExperimenterDesk::own_question() const {
  switch (own_) {
    case Own::pause_reason:
      return {Question::Kind::text, "Paused. The reason, if it should be recorded"};
    case Own::stop_reason:
      return {Question::Kind::text, "Stopped. The reason, without mentioning the texture"};
    case Own::note:
      return {Question::Kind::text, "Note"};
    case Own::code: {
      Question code{Question::Kind::text,
                    code_.empty() ? "Code of the deviation"
                                  : fmt::format("'{}' is only the beginning of a code", code_)};
      for (const std::string_view one : study::kDeviationCodes) {
        code.choices.push_back({std::string(one)});
      }
      return code;
    }
    case Own::remark:
      return {Question::Kind::text, "Deviation " + code_ + ", in words"};
    case Own::sure:
      return {Question::Kind::sure,
              "Abort ends this session for good; it cannot be resumed",
              {{kYes, "End the session"}}};
    case Own::abort_reason:
      return {Question::Kind::text, "The session ends. The reason"};
    case Own::none:
      break;
  }
  return {};
}

ExperimenterQuestion ExperimenterDesk::question() const {
  if (own_ != Own::none) return own_question();
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
  ++questions_;
  if (own_ != Own::none) {
    answer_own(text);
  } else if (spoken_) {
    answer_spoken(text);
  } else if (sheet_) {
    answer_sheet(text);
  }
}

void ExperimenterDesk::answer_own(const std::string& text) {
  switch (std::exchange(own_, Own::none)) {
    case Own::pause_reason:
      if (!text.empty()) ask(RequestKind::note, "pause: " + text);
      break;
    case Own::stop_reason:
      if (!text.empty()) ask(RequestKind::deviation, text, session::kComfortStopCode);
      break;
    case Own::note:
      if (!text.empty()) ask(RequestKind::note, text);
      break;
    case Own::code:
      code_ = text;
      if (!text.empty()) begin(is_half_typed(text) ? Own::code : Own::remark);
      break;
    case Own::remark:
      ask(RequestKind::deviation, text, code_);
      break;
    case Own::sure:
      if (text == kYes) begin(Own::abort_reason);
      break;
    case Own::abort_reason:
      ask(RequestKind::abort, text);
      break;
    case Own::none:
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
    if (status_.stage == kPaused && status.stage != kPaused) is_pause_asked_ = false;
    status_ = status;
  }
  show_faces();
}

void ExperimenterDesk::acknowledged(int /*trial*/) {
  each_face([](ExperimenterFace& face) { face.make_room(); });
}

std::optional<session::ExperimenterRequest> ExperimenterDesk::request() {
  each_face([](ExperimenterFace& face) { face.take_input(); });
  const std::lock_guard lock(mutex_);
  if (requests_.empty()) return std::nullopt;
  // Force requires that `ready` is shown again first.
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
  each_face([](ExperimenterFace& face) { face.take_input(); });
  {
    const std::lock_guard lock(mutex_);
    if (sheet_->ticks.size() == items.size()) {
      return std::exchange(sheet_, std::nullopt)->ticks;
    }
  }
  show_faces();
  each_face([](ExperimenterFace& face) { face.rest(); });
  return std::nullopt;
}

session::Attendant::Reply ExperimenterDesk::attend(const std::string& need) {
  forget_spoken_answer();  // the question of an interrupted trial would hide the request
  each_face([](ExperimenterFace& face) { face.take_input(); });
  Reply says{};
  {
    const std::lock_guard lock(mutex_);
    says = said(need.empty());
    waits_ = says == Reply::wait;
    need_ = need;
    is_ready_shown_ = waits_ && need.empty();
    is_armed_ = false;
    is_at_reset_ = false;
  }
  if (says != Reply::wait) return says;
  show_faces();
  each_face([](ExperimenterFace& face) { face.rest(); });
  return says;
}

/// When polled, the session records an abort, its reason and all other entries.
session::Attendant::Reply ExperimenterDesk::said(bool is_ready) const {
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
  each_face([](ExperimenterFace& face) { face.take_input(); });
  {
    const std::lock_guard lock(mutex_);
    const bool is_whole =
        spoken_->is_confirmed && (spoken_->confidence || step.confidence_levels == 0);
    if (is_whole) {
      const SpokenAnswer answer{*spoken_->label, spoken_->first, spoken_->confidence};
      spoken_.reset();
      return answer;
    }
  }
  show_faces();
  return std::nullopt;
}

void SpokenAnswers::see_pictures(const std::vector<std::string>& labels) {
  participant_.see_pictures(labels);
  positions_.resize(labels.size());
  std::iota(positions_.begin(), positions_.end(), 0);
  std::ranges::sort(positions_, {}, [&](int i) { return labels[static_cast<std::size_t>(i)]; });
  sorted_.clear();
  for (const int i : positions_) sorted_.push_back(labels[static_cast<std::size_t>(i)]);
}

std::optional<session::StepReply> SpokenAnswers::attend(const session::Step& step) {
  const auto shown = participant_.attend(step);
  const auto* asked = std::get_if<session::AnswerStep>(&step);
  if (asked == nullptr || asked->sight != study::Sight::blindfold) return shown;
  if (shown && shown->explore_again) return shown;
  const auto spoken = desk_.spoken_answer(*asked, sorted_);
  if (!spoken) return std::nullopt;
  session::StepReply reply;
  reply.at = std::chrono::steady_clock::now();
  Chosen chosen{positions_.at(spoken->label)};
  if (spoken->first) chosen.first_position = positions_.at(*spoken->first);
  reply.answer = chosen;
  reply.confidence = spoken->confidence;
  return reply;
}

}  // namespace touchtrial::app
