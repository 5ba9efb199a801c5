#include "app/windows/participant/answer_screen.hpp"
#include "app/windows/participant/page_layout.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "study/languages.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::app {
namespace {

constexpr int kOneColumn = 6;
constexpr std::size_t kMaxTextLength = 2000;
constexpr std::size_t kMaxNumberLength = 12;

bool is_number_character(char32_t letter) {
  return (letter >= U'0' && letter <= U'9') || letter == U'.' || letter == U',' || letter == U'-';
}

/// Converts to UTF-8; invalid code points are left out.
std::string utf8_of(const std::u32string& text) {
  std::string bytes;
  const auto put = [&bytes](char32_t value) { bytes += static_cast<char>(value); };
  for (const char32_t c : text) {
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0U | c >> 6U);
      put(0x80U | (c & 0x3FU));
    } else if (c < 0x10000 && (c < 0xD800 || c > 0xDFFF)) {
      put(0xE0U | c >> 12U);
      put(0x80U | (c >> 6U & 0x3FU));
      put(0x80U | (c & 0x3FU));
    } else if (c >= 0x10000 && c < 0x110000) {
      put(0xF0U | c >> 18U);
      put(0x80U | (c >> 12U & 0x3FU));
      put(0x80U | (c >> 6U & 0x3FU));
      put(0x80U | (c & 0x3FU));
    }
  }
  return bytes;
}

/// The typed number in the stored format, independent of the language.
std::string number_of(const std::u32string& text) {
  std::string number = utf8_of(text);
  std::replace(number.begin(), number.end(), ',', '.');
  return number;
}

}  // namespace

QuestionScreen::QuestionScreen(const session::QuestionStep& step, const ScreenContext& context)
    : questionnaire_(*step.questionnaire),
      context_(context),
      choices_(questionnaire_.questions.size(), -1),
      typed_texts_(questionnaire_.questions.size()),
      caret_(step.typed.size()) {
  if (!typed_texts_.empty()) typed_texts_.front().assign(step.typed.begin(), step.typed.end());
}

std::string QuestionScreen::translated(const study::Translated& text) const {
  for (const std::string& code : {context_.language, std::string("en")}) {
    if (const auto translation = text.find(code); translation != text.end())
      return translation->second;
  }
  return text.empty() ? "" : text.begin()->second;
}

bool QuestionScreen::is_invalid() const {
  if (question().kind != study::QuestionKind::number || typed_texts_[page_].empty()) return false;
  const auto number = number_in<double>(number_of(typed_texts_[page_]));
  return !number || !std::isfinite(*number) || (question().min && *number < *question().min) ||
         (question().max && *number > *question().max);
}

/// "18 - 99"; empty if the question has no bounds.
std::string QuestionScreen::range_text() const {
  const std::optional<double> min = question().min;
  const std::optional<double> max = question().max;
  std::string text;
  if (min && max) {
    text = number_text(*min) + " – " + number_text(*max);
  } else if (min) {
    text = "≥ " + number_text(*min);
  } else if (max) {
    text = "≤ " + number_text(*max);
  }
  if (study::has_decimal_comma(context_.language)) std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

bool QuestionScreen::is_answered() const {
  return question().kind == study::QuestionKind::choice ? choices_[page_] >= 0
                                                        : !typed_texts_[page_].empty();
}

void QuestionScreen::paint(Canvas& canvas) {
  const Words& words = *context_.words;
  if (questionnaire_.questions.empty()) return draw_footer(canvas, {{kNextTarget, words.next}});
  const int count = static_cast<int>(questionnaire_.questions.size());
  const int number = static_cast<int>(page_) + 1;
  draw_progress(canvas, {number - 1, count,
                         fill_numbers(words.question_of, {{"question", number}, {"of", count}})});
  const Box area = draw_heading(canvas, translated(question().text));
  if (question().kind == study::QuestionKind::choice) {
    paint_options(canvas, area);
  } else {
    paint_field(canvas, area);
  }
  std::vector<FooterButton> buttons;
  if (page_ > 0) buttons.push_back({kBackTarget, words.back, false});
  const bool is_skippable = !question().required && !is_answered();
  buttons.push_back(
      {kNextTarget, is_skippable ? words.skip : words.next, !is_skippable, can_continue()});
  draw_footer(canvas, buttons);
}

void QuestionScreen::paint_options(Canvas& canvas, const Box& area) {
  const double unit = canvas.unit();
  const int count = static_cast<int>(question().options.size());
  const int columns = count > kOneColumn ? 2 : 1;
  const int rows = (count + columns - 1) / columns;
  const double gap = 12.0 * unit;
  const double width = std::min(area.width, (columns == 1 ? 640.0 : 980.0) * unit);
  const double column_width = (width - gap * (columns - 1)) / columns;
  const double height = std::min(60.0 * unit, (area.height - gap * (rows - 1)) / rows);
  const double top = area.y + (area.height - rows * height - (rows - 1) * gap) / 2.0;
  for (int i = 0; i < count; ++i) {
    const Box box = {
        std::round(area.x + (area.width - width) / 2.0 + (i / rows) * (column_width + gap)),
        std::round(top + (i % rows) * (height + gap)), column_width, height};
    const std::string number = i < 9 ? std::to_string(i + 1) + "   " : "";
    canvas.draw_button(i, box, number + translated(question().options[static_cast<std::size_t>(i)]),
                       ButtonKind::line, true, choices_[page_] == i);
  }
}

void QuestionScreen::paint_field(Canvas& canvas, const Box& area) {
  const double unit = canvas.unit();
  const bool is_number = question().kind == study::QuestionKind::number;
  const double width = std::min(area.width, (is_number ? 320.0 : 860.0) * unit);
  const double height = is_number ? 72.0 * unit : std::min(area.height * 0.8, 260.0 * unit);
  const Box field = {std::round(area.x + (area.width - width) / 2.0),
                     std::round(area.y + (area.height - height) * 0.4), width, height};
  canvas.fill(field, tone::kCard, 10.0 * unit);
  canvas.outline(field, is_invalid() ? tone::kWarn : tone::kAccent, 2.0 * unit, 10.0 * unit);
  if (const std::string range = range_text(); !range.empty()) {
    canvas.draw_label({field.x, field.bottom() + 10.0 * unit, field.width, 34.0 * unit},
                      Letters::body, is_invalid() ? tone::kWarn : tone::kQuiet, range);
  }
  std::u32string text_with_caret = typed_text();
  text_with_caret.insert(std::min(caret_, text_with_caret.size()), 1, U'|');
  const Box inside = field.inset(18.0 * unit);
  if (typed_text().empty()) {
    const Words& words = *context_.words;
    canvas.draw_label({inside.x, inside.y, inside.width, std::min(inside.height, 36.0 * unit)},
                      Letters::body, tone::kQuiet, is_number ? words.number_hint : words.text_hint,
                      is_number ? Align::centre : Align::left);
    return;
  }
  const std::string text = utf8_of(text_with_caret);
  double shrink = 1.0;
  while (canvas.measure(Letters::body, text, inside.width, shrink) > inside.height &&
         shrink > 0.35) {
    shrink *= 0.94;
  }
  canvas.draw_text(inside, Letters::body, tone::kText, text,
                   is_number ? Align::centre : Align::left, shrink);
}

void QuestionScreen::choose(int option) {
  choices_[page_] = option;
  focus(kNextTarget);
}

std::optional<session::StepReply> QuestionScreen::activate(int id, Time /*at*/) {
  if (questionnaire_.questions.empty()) return session::StepReply{};
  if (id < kNextTarget) {
    choose(id);
    return std::nullopt;
  }
  focus(-1);
  if (id == kBackTarget) {
    if (page_ > 0) --page_;
    caret_ = typed_text().size();
    return std::nullopt;
  }
  if (!can_continue()) return std::nullopt;
  if (page_ + 1 < questionnaire_.questions.size()) {
    ++page_;
    caret_ = typed_text().size();
    return std::nullopt;
  }
  session::StepReply reply;
  reply.answers = answers();
  return reply;
}

std::vector<std::string> QuestionScreen::answers() const {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < questionnaire_.questions.size(); ++i) {
    switch (questionnaire_.questions[i].kind) {
      case study::QuestionKind::choice:
        texts.push_back(choices_[i] < 0 ? "" : std::to_string(choices_[i]));
        break;
      case study::QuestionKind::number:
        texts.push_back(number_of(typed_texts_[i]));
        break;
      case study::QuestionKind::text:
        texts.push_back(utf8_of(typed_texts_[i]));
        break;
    }
  }
  return texts;
}

bool QuestionScreen::handle_special_key(const InputEvent& event) {
  if (questionnaire_.questions.empty()) return false;
  if (question().kind == study::QuestionKind::choice) {
    const int count = static_cast<int>(question().options.size());
    if (event.kind != InputEvent::Kind::key || event.key != Key::digit) return false;
    if (event.digit >= 1 && event.digit <= count) choose(event.digit - 1);
    return true;
  }
  if (event.kind == InputEvent::Kind::letter) {
    insert(event.letter);
    return true;
  }
  return event.key == Key::space || edit(event.key);
}

void QuestionScreen::insert(char32_t letter) {
  const bool is_number = question().kind == study::QuestionKind::number;
  if (is_number && !is_number_character(letter)) return;
  if (letter < U' ' || typed_text().size() >= (is_number ? kMaxNumberLength : kMaxTextLength))
    return;
  typed_text().insert(std::min(caret_, typed_text().size()), 1, letter);
  ++caret_;
  focus(-1);
}

bool QuestionScreen::edit(Key key) {
  std::u32string& text = typed_text();
  caret_ = std::min(caret_, text.size());
  switch (key) {
    case Key::backspace:
      if (caret_ > 0) text.erase(--caret_, 1);
      return true;
    case Key::remove:
      if (caret_ < text.size()) text.erase(caret_, 1);
      return true;
    case Key::left:
      if (caret_ > 0) --caret_;
      return true;
    case Key::right:
      if (caret_ < text.size()) ++caret_;
      return true;
    case Key::home:
      caret_ = 0;
      return true;
    case Key::end:
      caret_ = text.size();
      return true;
    default:
      return false;
  }
}

}  // namespace touchtrial::app
