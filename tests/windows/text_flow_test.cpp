// Where lines of text break, and which letters fonts have.
#include "app/windows/text_flow.hpp"

#include "app/windows/look.hpp"
#include "core/errors.hpp"
#include "study/languages.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <imgui.h>

namespace touchtrial {
namespace {

constexpr double kSize = 20.0;

/// Fonts without a window.
class Faces {
 public:
  explicit Faces(const std::vector<std::string>& texts) : context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    const std::array<app::FontSize, 2> sizes = {
        {{20.0F, app::FontWeight::regular}, {20.0F, app::FontWeight::bold}}};
    fonts_ = app::load_letters(sizes, app::letters_in(texts));
  }
  ~Faces() { ImGui::DestroyContext(context_); }
  Faces(const Faces&) = delete;
  Faces& operator=(const Faces&) = delete;

  /// The lines of a text, with bold words between angle brackets.
  [[nodiscard]] std::vector<std::string> lines(const std::string& text, double width) const {
    std::vector<std::string> shown;
    for (const app::TextLine& line : app::lines_of(text, *fonts_[0], fonts_[1], kSize, width)) {
      std::string& all = shown.emplace_back();
      for (const app::TextRun& run : line.runs) all += run.bold ? "<" + run.text + ">" : run.text;
    }
    return shown;
  }
  [[nodiscard]] const ImFont& plain() const { return *fonts_[0]; }
  [[nodiscard]] const ImFont& bold() const { return *fonts_[1]; }

 private:
  ImGuiContext* context_;
  std::vector<ImFont*> fonts_;
};

using Lines = std::vector<std::string>;

/// A text without blanks, line feeds and marks of bold words.
std::string bare(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == '*'; });
  return text;
}

TEST_CASE("Latin lines break at blanks and line feeds; a word that is too long is cut") {
  const Faces faces({});
  CHECK(faces.lines("one two", 1000.0) == Lines{"one two"});
  CHECK(faces.lines("one\n\ntwo", 1000.0) == Lines{"one", "", "two"});
  CHECK(faces.lines("one two", 50.0) == Lines{"one", "two"});
  CHECK(faces.lines("a   b", 1000.0) == Lines{"a   b"});
  CHECK(faces.lines("", 50.0).empty());
  const Lines cut = faces.lines("incomprehensibilities", 60.0);
  CHECK(cut.size() > 2);
  std::string joined;
  for (const std::string& line : cut) joined += line;
  CHECK(joined == "incomprehensibilities");
  CHECK(faces.lines("word", 1.0) == Lines{"w", "o", "r", "d"});
}

TEST_CASE("no line begins with a question mark, even where a blank is before it") {
  const Faces faces({});
  CHECK(faces.lines("Vous avez\u00A0?", 95.0) == Lines{"Vous", "avez\u00A0?"});
  CHECK(faces.lines("Vous avez ?", 95.0) == Lines{"Vous", "avez ?"});
}

TEST_CASE("Chinese and Japanese lines break between letters, but not before closing marks") {
  const std::string text = "一二三，四五（六七）八九。「東京」っ";
  const Faces faces({text});
  for (int letters = 3; letters < 12; ++letters) {
    for (const std::string& line : faces.lines(text, letters * kSize)) {
      INFO(letters << ": " << line);
      const std::u32string points = app::code_points(line);
      REQUIRE_FALSE(points.empty());
      CHECK(std::u32string(U"，）。」っ").find(points.front()) == std::u32string::npos);
      CHECK(std::u32string(U"（「").find(points.back()) == std::u32string::npos);
    }
  }
  CHECK(faces.lines("東京東京東京", 1000.0).size() == 1);
  CHECK(faces.lines("東京東京東京", 2.0 * kSize).size() >= 3);
}

TEST_CASE("bold words are runs of their own, and break like others") {
  const Faces faces({"東"});
  CHECK(faces.lines("one **two** three", 1000.0) == Lines{"one <two> three"});
  CHECK(faces.lines("**one two**", 60.0) == Lines{"<one>", "<two>"});
  const auto plain = app::lines_of("**a**", faces.plain(), nullptr, kSize, 1000.0);
  REQUIRE(plain.size() == 1);
  CHECK(plain[0].runs.at(0).text == "**a**");
  CHECK_FALSE(plain[0].runs.at(0).bold);
  const auto runs = app::lines_of("a **b** c", faces.plain(), &faces.bold(), kSize, 1000.0)[0].runs;
  REQUIRE(runs.size() == 3);
  CHECK(runs[0].x == 0.0);
  CHECK(runs[1].x > runs[0].x);
  CHECK(runs[2].x > runs[1].x);
}

TEST_CASE("no language's text loses a letter by breaking, and no line is wider than it may be") {
  for (const std::string_view code : study::language_codes()) {
    const study::Language& language = study::language_of(code);
    std::vector<std::string> texts;
    for (const auto& [section, parts] : language.texts) {
      for (const auto& [key, text] : parts) texts.push_back(text);
    }
    const Faces faces(texts);
    for (const std::string& text : texts) {
      for (const double width : {90.0, 333.0, 800.0}) {
        INFO(language.code << ": " << text);
        std::string joined;
        for (const app::TextLine& line :
             app::lines_of(text, faces.plain(), &faces.bold(), kSize, width)) {
          CHECK(line.width <= width + 0.01);
          for (const app::TextRun& run : line.runs) joined += run.text;
        }
        CHECK(bare(joined) == bare(text));
      }
    }
  }
}

TEST_CASE("bytes that are not UTF-8 count as one unknown letter each") {
  CHECK(app::code_points("a\xFF\xE4z") == U"a\uFFFD\uFFFDz");
  CHECK(app::code_points("\xC3") == U"\uFFFD");
  CHECK(app::code_points("ü東\xF0\x9F\x98\x80") == U"ü東\U0001F600");
}

TEST_CASE("fonts are required for all letters of the texts; the message has letters and remedy") {
  for (const std::string_view code : study::language_codes()) {
    const study::Language& language = study::language_of(code);
    INFO(language.code);
    std::vector<std::string> texts;
    for (const auto& [section, parts] : language.texts) {
      for (const auto& [key, text] : parts) texts.push_back(text);
    }
    CHECK_NOTHROW(app::require_letters(app::letters_in(texts)));
  }
  try {
    app::require_letters({U'a', U'\uE000', U'\U0001F600'});
    FAIL("letters that no font has were accepted");
  } catch (const DeviceError& error) {
    const std::string message = error.what();
    INFO(message);
    CHECK(message.find("U+E000 U+1F600;") != std::string::npos);
    CHECK(message.find("fonts-droid-fallback") != std::string::npos);
    CHECK(message.find("U+0061") == std::string::npos);
  }
}

}  // namespace
}  // namespace touchtrial
