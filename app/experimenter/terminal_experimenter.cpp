#include "app/experimenter/terminal_experimenter.hpp"

#include "app/experimenter/status_words.hpp"
#include "app/terminal_keys.hpp"
#include "device/platform/stop_signals.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include <sys/ioctl.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

int columns_of_terminal() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

}  // namespace

ExperimenterTerminal standard_terminal() {
  ExperimenterTerminal terminal;
  if (::isatty(STDIN_FILENO) != 0) {
    terminal.key = [keys = std::make_shared<TerminalKeys>()] { return keys->next(); };
  }
  device::StopOnSignals::before_dying(TerminalKeys::restore);
  terminal.write = [](const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
  };
  terminal.rewrites = ::isatty(STDERR_FILENO) != 0;
  terminal.columns = columns_of_terminal();
  terminal.pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  return terminal;
}

TerminalExperimenter::TerminalExperimenter(ExperimenterTerminal terminal)
    : terminal_(std::move(terminal)) {
  if (terminal_.key) write_line(request_keys_help());
}

TerminalExperimenter::~TerminalExperimenter() {
  end_line();
}

void TerminalExperimenter::end_line() {
  if (terminal_.rewrites && !shown_.empty()) terminal_.write("\n");
  shown_.clear();
}

void TerminalExperimenter::acknowledged(int /*trial*/) {
  if (terminal_.rewrites && !shown_.empty()) terminal_.write("\r\x1b[K");
  shown_.clear();
}

void TerminalExperimenter::add(const session::ExperimenterRequest& request) {
  const std::lock_guard lock(mutex_);
  added_.push_back(request);
}

void TerminalExperimenter::take_keys() {
  if (!terminal_.key) return;
  while (const auto key = terminal_.key()) take(*key);
}

void TerminalExperimenter::take(char key) {
  const bool is_of_number =
      (key >= '0' && key <= '9') || key == '\n' || key == '\r' || key == '\x7f' || key == '\b';
  const bool is_of_sheet = key == 'y' || key == 's' || key == 'b' || key == '\n' || key == '\r';
  if (!typing_.prompt().empty()) {
    typing_.take(key);
  } else if (sheet_ && is_of_sheet) {
    sheet_->take(key);
  } else if (spoken_ && is_of_number) {
    spoken_->take(key);
  } else if (key == 'g') {
    arm_asked_ = is_ready_shown_;
  } else if (key == 'h' && !need_.empty()) {
    at_reset_ = true;
  } else {
    typing_.take(key);
  }
}

std::string TerminalExperimenter::line_now() const {
  if (std::string prompt = typing_.prompt(); !prompt.empty()) return prompt;
  if (sheet_) return sheet_->prompt();
  if (spoken_) return spoken_->prompt();
  return need_.empty() ? status_ : need_;
}

void TerminalExperimenter::write_line(const std::string& line) {
  terminal_.write(line + "\n");
}

void TerminalExperimenter::rewrite(const std::string& line) {
  // A wrapped line cannot be overwritten; of a typed line, the end is what matters.
  const std::string cut = last_of(line, terminal_.columns - 1);
  if (cut == shown_) return;
  shown_ = cut;
  if (terminal_.rewrites) {
    terminal_.write("\r" + cut + "\x1b[K");
  } else {
    write_line(line);
  }
}

void TerminalExperimenter::show(const session::SessionStatus& status) {
  tell_stop(status);
  status_ = first_of(status_line(status), terminal_.columns - 1);
  if (terminal_.rewrites) {
    rewrite(line_now());
    return;
  }
  const std::string progress = progress_words(status);
  if (progress == progress_) return;
  progress_ = progress;
  write_line(status_line(status));
}

void TerminalExperimenter::tell_stop(const session::SessionStatus& status) {
  const bool is_news = status.participant_stopped && !is_stop_told_;
  is_stop_told_ = status.participant_stopped;
  if (!is_news) return;
  if (terminal_.rewrites) terminal_.write("\a\r\x1b[K");
  write_line("The participant has stopped the force. " + stop_advice(status));
  shown_.clear();
}

std::optional<session::ExperimenterRequest> TerminalExperimenter::request() {
  take_keys();
  if (auto typed = typing_.next()) {
    // The force may only come on after the line that announces it is shown again.
    is_ready_shown_ = false;
    arm_asked_ = false;
    return typed;
  }
  const std::lock_guard lock(mutex_);
  if (added_.empty()) return std::nullopt;
  session::ExperimenterRequest first = added_.front();
  added_.erase(added_.begin());
  return first;
}

std::optional<std::vector<session::Tick>> TerminalExperimenter::day_sheet(
    const std::vector<session::DaySheetItem>& items) {
  if (!terminal_.key) return std::vector<session::Tick>{};
  if (!sheet_) sheet_.emplace(items);
  take_keys();
  if (sheet_->is_done()) {
    std::vector<session::Tick> ticks = sheet_->ticks();
    sheet_.reset();
    return ticks;
  }
  show_item(sheet_->text());
  rewrite(line_now());
  if (terminal_.pause) terminal_.pause();
  return std::nullopt;
}

void TerminalExperimenter::show_item(const std::string& text) {
  if (text == item_) return;
  item_ = text;
  if (terminal_.rewrites) terminal_.write("\r\x1b[K");
  write_line(text);
  shown_.clear();
}

session::Attendant::Says TerminalExperimenter::attend(const std::string& need) {
  spoken_.reset();  // its line, of an interrupted trial, would hide what is needed
  take_keys();
  const Says says = said(need.empty());
  is_ready_shown_ = says == Says::wait && need.empty();
  arm_asked_ = false;
  at_reset_ = false;
  need_.clear();
  if (says != Says::wait) return says;
  need_ = need.empty() ? "ready: g switches the force on, once the hand is at the pen"
                       : "the device waits: " + need;
  rewrite(line_now());
  if (terminal_.pause) terminal_.pause();
  return says;
}

session::Attendant::Says TerminalExperimenter::said(bool is_ready) {
  bool stops = false;
  // When the session asks, it records the abort, its reason and everything else that was typed.
  while (const auto request = typing_.next()) {
    stops = stops || request->kind == session::ExperimenterRequest::Kind::abort;
    add(*request);
  }
  if (stops) return Says::stop;
  if (is_ready) return arm_asked_ ? Says::arm : Says::wait;
  return at_reset_ ? Says::at_reset : Says::wait;
}

void TerminalExperimenter::forget_spoken_answer() {
  spoken_.reset();
}

std::optional<SpokenAnswer> TerminalExperimenter::spoken_answer(
    const session::AnswerStep& step, const std::vector<std::string>& labels) {
  if (!spoken_) spoken_.emplace(step, labels);
  take_keys();
  const std::optional<SpokenAnswer> answer = spoken_->answer();
  if (answer) {
    spoken_.reset();
  } else {
    rewrite(line_now());
  }
  return answer;
}

}  // namespace touchtrial::app
