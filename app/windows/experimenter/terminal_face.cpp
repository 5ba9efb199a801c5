#include "app/windows/experimenter/terminal_face.hpp"

#include "app/terminal/terminal_keys.hpp"
#include "app/windows/experimenter/status_words.hpp"
#include "core/text.hpp"
#include "device/platform/stop_signals.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include <sys/ioctl.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

using Question = ExperimenterQuestion;

constexpr char kEscape = '\x1b';
constexpr char kTab = '\t';
constexpr std::size_t kMaxLineBytes = 500;
constexpr const char* kClearLine = "\r\x1b[K";

int columns_of_terminal() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

bool ends_line(char key) {
  return key == '\n' || key == '\r';
}

bool is_delete_key(char key) {
  return key == '\x7f' || key == '\b';
}

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

std::string keys_help() {
  return "keys: " + listed(kExperimenterActions, ", ", [](const ExperimenterAction& action) {
           return std::string(1, action.key) + " " + action.label;
         });
}

std::string words_of(const Question::Choice& choice, Question::Kind kind) {
  const std::string key = kind == Question::Kind::number ? choice.answer
                          : ends_line(choice.key)        ? ""
                                                         : std::string(1, choice.key);
  return (key.empty() ? "Enter" : key) + (choice.label.empty() ? "" : " " + choice.label);
}

}  // namespace

ExperimenterTerminal standard_terminal() {
  ExperimenterTerminal terminal;
  if (::isatty(STDIN_FILENO) != 0) {
    terminal.key = [keys = std::make_shared<TerminalKeys>()] { return keys->next(); };
  }
  device::StopOnSignals::set_crash_cleanup(TerminalKeys::restore);
  terminal.write = [](const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
  };
  terminal.can_rewrite = ::isatty(STDERR_FILENO) != 0;
  terminal.columns = columns_of_terminal();
  terminal.pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  return terminal;
}

bool TypedLine::add_key(char key) {
  if (ends_line(key)) return true;
  if (is_delete_key(key)) {
    while (!text_.empty() && continues_character(text_.back())) text_.pop_back();
    if (!text_.empty()) text_.pop_back();
    return false;
  }
  const bool is_control = static_cast<unsigned char>(key) < 0x20U;
  // The length limit refuses only a character's first byte, so that no character is cut in two.
  if (is_control || (text_.size() >= kMaxLineBytes && !continues_character(key))) return false;
  text_ += key;
  return false;
}

TerminalFace::TerminalFace(ExperimenterDesk& desk, ExperimenterTerminal terminal)
    : desk_(desk), terminal_(std::move(terminal)) {
  if (terminal_.key) write_above(keys_help());
  desk_.add_face(*this);
}

TerminalFace::~TerminalFace() {
  desk_.remove_face(*this);
  end_line();
}

void TerminalFace::end_line() {
  if (terminal_.can_rewrite && !shown_line_.empty()) terminal_.write("\n");
  shown_line_.clear();
}

void TerminalFace::clear_line() {
  if (terminal_.can_rewrite && !shown_line_.empty()) terminal_.write(kClearLine);
  shown_line_.clear();
}

void TerminalFace::sleep_briefly() {
  if (terminal_.pause) terminal_.pause();
}

void TerminalFace::read_input() {
  if (!terminal_.key) return;
  while (const auto key = terminal_.key()) handle_key(*key);
}

void TerminalFace::handle_key(char key) {
  const ExperimenterView view = desk_.view();
  if (std::exchange(question_number_, view.question_number) != view.question_number) line_.set("");
  if (answer_with(view.question, key)) return;
  const auto action = std::ranges::find(kExperimenterActions, key, &ExperimenterAction::key);
  if (action != kExperimenterActions.end()) desk_.act(action->kind);
}

bool TerminalFace::answer_with(const ExperimenterQuestion& question, char key) {
  switch (question.kind) {
    case Question::Kind::none:
      return false;
    case Question::Kind::keys: {
      const char pressed = key == 'y' || key == '\r' ? '\n' : key;
      const auto choice = std::ranges::find(question.choices, pressed, &Question::Choice::key);
      if (choice == question.choices.end()) return false;
      desk_.answer(choice->answer);
      return true;
    }
    case Question::Kind::number:
      if (!ends_line(key) && !is_delete_key(key) && (key < '0' || key > '9')) return false;
      break;
    case Question::Kind::text:
    case Question::Kind::confirm:
      if (key == kEscape) line_.set("");
      if (key == kEscape) desk_.discard();
      if (key == kTab) complete(question);
      if (key == kEscape || key == kTab) return true;
      break;
  }
  if (!line_.add_key(key)) return true;
  const std::string text = line_.text();
  line_.set("");
  desk_.answer(text);
  return true;
}

/// Completes to the next choice with the typed prefix, cyclically.
void TerminalFace::complete(const ExperimenterQuestion& question) {
  const auto& choices = question.choices;
  const auto current_choice = std::ranges::find(choices, line_.text(), &Question::Choice::answer);
  if (current_choice == choices.end() || !current_choice->answer.starts_with(prefix_))
    prefix_ = line_.text();
  const std::size_t first_index =
      current_choice == choices.end()
          ? 0
          : 1 + static_cast<std::size_t>(current_choice - choices.begin());
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const std::string& answer = choices[(first_index + i) % choices.size()].answer;
    if (answer.starts_with(prefix_)) return line_.set(answer);
  }
}

std::string TerminalFace::prompt(const ExperimenterQuestion& question) const {
  switch (question.kind) {
    case Question::Kind::confirm:
      return question.text + "; type " + question.choices.front().answer + ": " + line_.text();
    case Question::Kind::text:
      return question.text + (question.choices.empty() ? "" : " (Tab: next suggestion)") + ": " +
             line_.text();
    case Question::Kind::number:
    case Question::Kind::keys:
      break;
    case Question::Kind::none:
      return "";
  }
  const bool is_by_keys = question.kind == Question::Kind::keys;
  return (is_by_keys ? "" : question.text + " ") +
         listed(question.choices, ", ",
                [&](const Question::Choice& choice) { return words_of(choice, question.kind); }) +
         ": " + line_.text();
}

void TerminalFace::write_above(const std::string& line) {
  clear_line();
  terminal_.write(line + "\n");
}

void TerminalFace::rewrite(const std::string& line) {
  // A wrapped line cannot be overwritten, so the start of a long typed line is cut off.
  const std::string visible_line = last_characters(line, terminal_.columns - 1);
  if (visible_line == shown_line_) return;
  shown_line_ = visible_line;
  terminal_.write(terminal_.can_rewrite ? "\r" + visible_line + "\x1b[K" : line + "\n");
}

void TerminalFace::show(const ExperimenterView& view) {
  const session::SessionStatus& status = view.status;
  if (status.participant_stopped && !is_stop_announced_) {
    if (terminal_.can_rewrite) terminal_.write("\a");
    write_above("The participant has stopped the force. " + stop_advice(status));
  }
  is_stop_announced_ = status.participant_stopped;
  const bool is_item = view.question.kind == Question::Kind::keys;
  if (is_item && view.question.text != shown_item_) write_above(view.question.text);
  shown_item_ = is_item ? view.question.text : "";
  if (std::exchange(question_number_, view.question_number) != view.question_number) line_.set("");
  if (view.question.kind != Question::Kind::none) return rewrite(prompt(view.question));
  if (!view.need.empty()) return rewrite(view.need);
  if (terminal_.can_rewrite)
    return rewrite(first_characters(status_line(status), terminal_.columns - 1));
  const std::string progress = progress_words(status);
  if (std::exchange(shown_progress_, progress) != progress) write_above(status_line(status));
}

}  // namespace touchtrial::app
