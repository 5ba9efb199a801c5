#include "app/participant/simple_screens.hpp"

#include <utility>

namespace touchtrial::app {

void NoteScreen::paint(Canvas& canvas) {
  draw_progress(canvas, content_.progress);
  draw_card(canvas, content_.title, content_.body, content_.note);
  if (!content_.button.empty()) draw_footer(canvas, {{kNextTarget, content_.button}});
}

std::optional<session::StepReply> NoteScreen::activate(int /*id*/, Time /*at*/) {
  return session::StepReply{};
}

PagesScreen::PagesScreen(std::vector<std::string> pages, const Words& words)
    : pages_(std::move(pages)), words_(words) {
  if (pages_.empty()) pages_.emplace_back();
}

void PagesScreen::paint(Canvas& canvas) {
  const int count = static_cast<int>(pages_.size());
  const int page = static_cast<int>(page_) + 1;
  if (count > 1) draw_progress(canvas, {page, count, with_numbers(words_.page_of, {page, count})});
  // A short first line is the page's heading.
  const std::string& text = pages_[page_];
  const std::size_t line = text.find('\n');
  std::string title;
  std::string body = text;
  constexpr std::size_t kLongestHeading = 60;
  if (line != std::string::npos && line <= kLongestHeading) {
    title = text.substr(0, line);
    body = text.substr(text.find_first_not_of('\n', line) == std::string::npos
                           ? text.size()
                           : text.find_first_not_of('\n', line));
  }
  draw_card(canvas, title, body, "", Align::left);
  std::vector<FooterButton> buttons;
  if (page_ > 0) buttons.push_back({kBackTarget, words_.back, false});
  buttons.push_back({kNextTarget, words_.next});
  draw_footer(canvas, buttons);
}

std::optional<session::StepReply> PagesScreen::activate(int id, Time /*at*/) {
  focus(-1);
  if (id == kBackTarget) {
    if (page_ > 0) --page_;
    return std::nullopt;
  }
  if (++page_ < pages_.size()) return std::nullopt;
  page_ = pages_.size() - 1;
  return session::StepReply{};
}

}  // namespace touchtrial::app
