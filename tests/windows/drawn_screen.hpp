/// \file Screens of participants that are drawn without a window, and what is wrong with their
/// layout.
#pragma once

#include "app/windows/participant/canvas.hpp"
#include "app/windows/participant/screen.hpp"
#include "study/languages.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>

namespace touchtrial {

/// Square pictures of one size.
class Squares final : public app::PictureShelf {
 public:
  explicit Squares(double side_mm) : side_mm_(side_mm) {}
  [[nodiscard]] Vec2 size_mm(const std::string& /*label*/) const override {
    return {side_mm_, side_mm_};
  }
  [[nodiscard]] void* texture(const std::string& /*label*/, int /*w*/, int /*h*/) override {
    return nullptr;
  }

 private:
  double side_mm_;
};

inline const app::Words& words_in(const std::string& language) {
  static std::map<std::string, app::Words> all;
  const auto [place, is_new] = all.try_emplace(language);
  if (is_new) place->second = app::words_of(study::language_of(language).texts);
  return place->second;
}

/// Dear ImGui without a window or a graphics card.
class Paper {
 public:
  explicit Paper(Vec2 size, double text_scale = 1.0, const std::set<char32_t>& letters = {})
      : size_(size), context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    fonts_ = app::load_participant_fonts(text_scale * app::design_unit(size), letters);
  }
  ~Paper() { ImGui::DestroyContext(context_); }
  Paper(const Paper&) = delete;
  Paper& operator=(const Paper&) = delete;

  [[nodiscard]] app::Canvas draw(app::Screen& screen, bool high_contrast = false) const {
    ImGui::SetCurrentContext(context_);
    ImGui::NewFrame();
    app::Canvas canvas(*ImGui::GetBackgroundDrawList(), fonts_, size_, screen.attention(),
                       high_contrast);
    screen.draw(canvas);
    ImGui::EndFrame();
    return canvas;
  }
  [[nodiscard]] Vec2 size() const noexcept { return size_; }

 private:
  Vec2 size_;
  ImGuiContext* context_;
  app::Fonts fonts_;
};

inline app::InputEvent key(app::Key which, int digit = 0) {
  return {.key = which, .digit = digit};
}

/// A screen on paper, with what it is drawn from.
struct Drawn {
  explicit Drawn(const session::Step& step, const std::string& language = "en",
                 const std::vector<std::string>& labels = {})
      : context{.words = &words_in(language),
                .language = language,
                .shelf = &shelf,
                .physical_scale = &physical_scale},
        screen(app::screen_for(step, context, labels)) {}
  [[nodiscard]] app::Canvas draw() { return paper.draw(*screen); }
  std::optional<session::StepReply> press(app::Key which, int digit = 0) {
    std::optional<session::StepReply> reply = screen->handle(key(which, digit));
    static_cast<void>(draw());
    return reply;
  }
  /// Types letters.
  void write(const std::u32string& letters) {
    for (const char32_t letter : letters) {
      app::InputEvent event{.kind = app::InputEvent::Kind::letter, .letter = letter};
      CHECK_FALSE(screen->handle(event));
    }
  }

  Paper paper{{1280.0, 720.0}};
  Squares shelf{51.2};
  app::PhysicalScale physical_scale{0.27, true};
  app::ScreenContext context;
  std::shared_ptr<app::Screen> screen;
};

inline bool lies_inside(const app::Box& inner, const app::Box& outer) {
  constexpr double kRounding = 1.5;
  return inner.x >= outer.x - kRounding && inner.y >= outer.y - kRounding &&
         inner.right() <= outer.right() + kRounding && inner.bottom() <= outer.bottom() + kRounding;
}

inline bool overlap(const app::Box& a, const app::Box& b) {
  constexpr double kRounding = 1.5;
  return a.x + kRounding < b.right() && b.x + kRounding < a.right() &&
         a.y + kRounding < b.bottom() && b.y + kRounding < a.bottom();
}

/// \return faults of a picture, one line each; empty if there are none
inline std::string faults_of(const app::Canvas& canvas) {
  std::string faults;
  const app::Box all = {0.0, 0.0, canvas.size().x, canvas.size().y};
  const std::vector<app::PlacedText>& texts = canvas.texts();
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!lies_inside(texts[i].box, all)) faults += "off the screen: " + texts[i].text + "\n";
    if (!lies_inside(texts[i].box, texts[i].room)) faults += "clipped: " + texts[i].text + "\n";
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(texts[i].box, texts[j].box)) {
        faults += "'" + texts[i].text + "' lies over '" + texts[j].text + "'\n";
      }
    }
  }
  if (!canvas.missing_letters().empty()) faults += "a letter that no font has\n";
  const std::vector<app::Target>& targets = canvas.targets();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (!lies_inside(targets[i].box, all)) faults += "a button is off the screen\n";
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(targets[i].box, targets[j].box)) faults += "two buttons overlap\n";
    }
  }
  return faults;
}

/// The texts of a language's files.
inline std::vector<std::string> all_texts(const std::string& language) {
  std::vector<std::string> texts = {"≤≥"};
  for (const auto& [section, parts] : study::language_of(language).texts) {
    for (const auto& [key, text] : parts) texts.push_back(text);
  }
  return texts;
}

inline bool shows(const app::Canvas& canvas, const std::string& part) {
  return std::ranges::any_of(canvas.texts(), [&](const app::PlacedText& placed) {
    return placed.text.find(part) != std::string::npos;
  });
}

}  // namespace touchtrial
