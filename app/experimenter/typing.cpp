#include "app/experimenter/typing.hpp"

#include "app/console.hpp"
#include "core/text.hpp"
#include "protocols/design/deviation_codes.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {

void SpokenAnswers::see_pictures(const std::vector<std::string>& labels) {
  participant_.see_pictures(labels);
  positions_.resize(labels.size());
  std::iota(positions_.begin(), positions_.end(), 0);
  std::sort(positions_.begin(), positions_.end(), [&](int a, int b) {
    return labels[static_cast<std::size_t>(a)] < labels[static_cast<std::size_t>(b)];
  });
  sorted_.clear();
  for (const int position : positions_) {
    sorted_.push_back(labels[static_cast<std::size_t>(position)]);
  }
}

std::optional<session::StepReply> SpokenAnswers::attend(const session::Step& step) {
  const auto shown = participant_.attend(step);
  const auto* asked = std::get_if<session::AnswerStep>(&step);
  if (asked == nullptr || asked->sight != design::Sight::blindfold) return shown;
  if (shown && shown->explore_again) return shown;
  const auto spoken = entry_.spoken_answer(*asked, sorted_);
  if (!spoken) return std::nullopt;
  session::StepReply reply;
  reply.at = std::chrono::steady_clock::now();
  reply.position = positions_.at(spoken->label);
  if (spoken->first) reply.first_position = positions_.at(*spoken->first);
  reply.confidence = spoken->confidence;
  return reply;
}

namespace {

using Kind = session::ExperimenterRequest::Kind;

constexpr char kEscape = '\x1b';
constexpr char kTab = '\t';
constexpr std::size_t kLongest = 500;

bool ends_line(char key) {
  return key == '\n' || key == '\r';
}

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// A whole number from 1 to `most`; 0 for any other text.
int choice_in(const std::string& text, int most) {
  const auto number = number_in<int>(text);
  return number && *number >= 1 && *number <= most ? *number : 0;
}

}  // namespace

bool TypedLine::take(char key) {
  if (ends_line(key)) return true;
  if (key == '\x7f' || key == '\b') {
    while (!text_.empty() && continues_character(text_.back())) text_.pop_back();
    if (!text_.empty()) text_.pop_back();
    return false;
  }
  const bool is_control = static_cast<unsigned char>(key) < 0x20U;
  // Only the first byte of a character is refused for length, so that no character is cut in two.
  if (is_control || (text_.size() >= kLongest && !continues_character(key))) return false;
  text_ += key;
  return false;
}

void RequestTyping::take(char key) {
  if (key == kEscape) {
    field_ = Field::none;
    line_.clear();
  } else if (key == kTab && field_ == Field::code) {
    complete_code();
  } else if (field_ == Field::none) {
    begin(key);
  } else if (line_.take(key)) {
    end_line();
  }
}

std::optional<session::ExperimenterRequest> RequestTyping::next() {
  if (requests_.empty()) return std::nullopt;
  session::ExperimenterRequest request = std::move(requests_.front());
  requests_.pop_front();
  return request;
}

void RequestTyping::ask(session::ExperimenterRequest::Kind kind, const std::string& text,
                        const std::string& code) {
  requests_.push_back({kind, text, code});
}

/// The next code that begins with what was typed before Tab, in a circle.
void RequestTyping::complete_code() {
  const auto& codes = design::kDeviationCodes;
  const auto now = std::ranges::find(codes, line_.text());
  if (now == codes.end() || !now->starts_with(code_)) code_ = line_.text();
  const std::size_t from =
      now == codes.end() ? 0 : 1 + static_cast<std::size_t>(now - codes.begin());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::string_view code = codes[(from + i) % codes.size()];
    if (!code.starts_with(code_)) continue;
    line_.clear();
    for (const char letter : code) static_cast<void>(line_.take(letter));
    return;
  }
}

void RequestTyping::begin(char key) {
  switch (key) {
    case 'p':
      ask(Kind::pause);
      field_ = Field::pause_reason;
      break;
    case 'c':
      ask(Kind::comfort_stop);
      field_ = Field::stop_reason;
      break;
    case 'r':
      ask(Kind::resume);
      break;
    case 'n':
      field_ = Field::note;
      break;
    case 'd':
      code_.clear();
      field_ = Field::code;
      break;
    case 'a':
      field_ = Field::sure;
      break;
    default:
      break;
  }
}

void RequestTyping::end_line() {
  const std::string text = line_.text();
  line_.clear();
  const Field ended = std::exchange(field_, Field::none);
  switch (ended) {
    case Field::pause_reason:
      if (!text.empty()) ask(Kind::note, "pause: " + text);
      break;
    case Field::stop_reason:
      if (!text.empty()) ask(Kind::deviation, text, session::kComfortStopCode);
      break;
    case Field::note:
      if (!text.empty()) ask(Kind::note, text);
      break;
    case Field::code:
      code_ = text;
      if (!text.empty()) field_ = Field::remark;
      break;
    case Field::remark:
      ask(Kind::deviation, text, code_);
      break;
    case Field::sure:
      if (text == "yes") field_ = Field::abort_reason;
      break;
    case Field::abort_reason:
      ask(Kind::abort, text);
      break;
    case Field::none:
      break;
  }
}

std::string RequestTyping::prompt() const {
  switch (field_) {
    case Field::none:
      return "";
    case Field::pause_reason:
      return "paused; reason (then r resumes): " + line_.text();
    case Field::stop_reason:
      return "stopped; reason, without a word about the texture: " + line_.text();
    case Field::note:
      return "note: " + line_.text();
    case Field::code:
      return "deviation code (Tab: the next of the program's): " + line_.text();
    case Field::remark:
      return "deviation " + code_ + ", in words: " + line_.text();
    case Field::sure:
      return "end this session for good? type yes: " + line_.text();
    case Field::abort_reason:
      return "reason for the abort: " + line_.text();
  }
  return "";
}

const char* request_keys_help() noexcept {
  return "keys: p pause, r resume, c comfort stop, n note, d deviation, a abort";
}

AnswerTyping::AnswerTyping(const session::AnswerStep& step, std::vector<std::string> labels)
    : step_(step), labels_(std::move(labels)) {}

void AnswerTyping::take(char key) {
  if (!answer_ && line_.take(key)) end_line();
}

void AnswerTyping::choose(int number) {
  const auto label = static_cast<std::size_t>(number - 1);
  if (is_chosen_ && label == typed_.label) return;
  if (is_chosen_) {
    if (typed_.first) return;
    typed_.first = typed_.label;
  }
  typed_.label = label;
  is_chosen_ = true;
}

void AnswerTyping::end_line() {
  const std::string text = line_.text();
  line_.clear();
  if (is_confirmed_) {
    const int confidence = choice_in(text, step_.confidence_levels);
    if (confidence == 0) return;
    typed_.confidence = confidence;
    answer_ = typed_;
    return;
  }
  if (const int number = choice_in(text, static_cast<int>(labels_.size())); number > 0) {
    choose(number);
  } else if (text.empty() && is_chosen_) {
    is_confirmed_ = true;
    if (step_.confidence_levels == 0) answer_ = typed_;
  }
}

std::string AnswerTyping::prompt() const {
  if (is_confirmed_) {
    return fmt::format("trial {}: confidence, 1 to {}: {}", step_.trial, step_.confidence_levels,
                       line_.text());
  }
  std::string prompt = fmt::format("trial {}:", step_.trial);
  if (is_chosen_) {
    return prompt + fmt::format(" {}; Enter confirms{}: {}", labels_[typed_.label],
                                typed_.first ? "" : ", a number changes it", line_.text());
  }
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    prompt += fmt::format(" {} {}", i + 1, labels_[i]);
  }
  return prompt + ": " + line_.text();
}

TickList::TickList(std::vector<session::DaySheetItem> items) : items_(std::move(items)) {}

void TickList::take(char key) {
  if (key == 'b' && !ticks_.empty()) {
    ticks_.pop_back();
    return;
  }
  if (is_done()) return;
  if (key == '\n' || key == '\r' || key == 'y') {
    ticks_.push_back(session::Tick::done);
  } else if (key == 's') {
    ticks_.push_back(session::Tick::skipped);
  }
}

std::string TickList::text() const {
  if (is_done()) return "";
  return fmt::format("{}/{} {}", ticks_.size() + 1, items_.size(), items_[ticks_.size()].text);
}

std::string TickList::prompt() const {
  if (is_done()) return "";
  return fmt::format("Enter: done, s: skip ({}), b: back ", items_[ticks_.size()].code);
}

}  // namespace touchtrial::app
