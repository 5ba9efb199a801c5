#include "app/experimenter/request_typing.hpp"

#include <utility>

namespace touchtrial::app {
namespace {

constexpr char kEscape = '\x1b';
constexpr std::size_t kLongest = 500;

bool ends_line(char key) {
  return key == '\n' || key == '\r';
}

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
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
  // A character is not cut in two: only its first byte is refused for length.
  if (is_control || (text_.size() >= kLongest && !continues_character(key))) return false;
  text_ += key;
  return false;
}

void RequestTyping::take(char key) {
  if (key == kEscape) {
    field_ = Field::none;
    line_.clear();
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

void RequestTyping::begin(char key) {
  using Kind = session::ExperimenterRequest::Kind;
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
  using Kind = session::ExperimenterRequest::Kind;
  const std::string text = line_.text();
  line_.clear();
  const Field ended = std::exchange(field_, Field::none);
  switch (ended) {
    case Field::pause_reason:
      if (!text.empty()) ask(Kind::note, "pause: " + text);
      break;
    case Field::stop_reason:
      if (!text.empty()) ask(Kind::note, "comfort stop: " + text);
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
      return "paused; reason (r after it resumes): " + line_.text();
    case Field::stop_reason:
      return "stopped; reason, nothing about the texture: " + line_.text();
    case Field::note:
      return "note: " + line_.text();
    case Field::code:
      return "deviation code: " + line_.text();
    case Field::remark:
      return "deviation " + code_ + ", in words: " + line_.text();
    case Field::sure:
      return "end this session for good? type yes: " + line_.text();
    case Field::abort_reason:
      return "reason for the end: " + line_.text();
  }
  return "";
}

const char* request_keys_help() noexcept {
  return "keys: p pause, r resume, c comfort stop, n note, d deviation, a abort";
}

}  // namespace touchtrial::app
