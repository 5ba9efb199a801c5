#include "app/experimenter/console_panel.hpp"

#include "app/experimenter/status_words.hpp"
#include "app/windows/look.hpp"
#include "protocols/design/deviation_codes.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

using Kind = session::ExperimenterRequest::Kind;

constexpr PackedColour kInk = 0xFF202020;
constexpr PackedColour kGround = 0xFFF6F4F2;
constexpr float kMargin = 20.0F;
constexpr float kButtonHeight = 44.0F;
constexpr std::size_t kAskedShown = 6;
constexpr const char* kPaused = "paused";

/// Light, like the participant's window.
class Look {
 public:
  explicit Look(float density) {
    ImGui::StyleColorsLight();
    colour(ImGuiCol_Text, kInk);
    colour(ImGuiCol_WindowBg, kGround);
    colour(ImGuiCol_FrameBg, kWhite);
    colour(ImGuiCol_Button, kPale);
    colour(ImGuiCol_ButtonHovered, 0xFFD4D0CC);
    colour(ImGuiCol_ButtonActive, 0xFFC0BCB8);
    colour(ImGuiCol_PlotHistogram, kBlue);
    space(ImGuiStyleVar_WindowPadding, {kMargin * density, kMargin * density});
    space(ImGuiStyleVar_FramePadding, {12.0F * density, 9.0F * density});
    space(ImGuiStyleVar_CellPadding, {0.0F, 6.0F * density});
    space(ImGuiStyleVar_ItemSpacing, {10.0F * density, 10.0F * density});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 5.0F * density);
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1.0F);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    spaces_ += 3;
  }
  ~Look() {
    ImGui::PopStyleVar(spaces_);
    ImGui::PopStyleColor(colours_);
  }
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;

 private:
  void colour(ImGuiCol which, PackedColour to) {
    ImGui::PushStyleColor(which, to);
    ++colours_;
  }
  void space(ImGuiStyleVar which, ImVec2 to) {
    ImGui::PushStyleVar(which, to);
    ++spaces_;
  }

  int colours_ = 0;
  int spaces_ = 0;
};

void large(const std::string& text) {
  ImGui::PushFont(ImGui::GetIO().Fonts->Fonts[kLargeFont]);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
}

void grey(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
}

void draw_heading(const session::SessionStatus& status) {
  large(status.participant.empty() ? "no session yet" : status.participant);
  std::string stage = status.stage;
  if (status.practice && status.stage != "practice") stage += " (practice)";
  ImFont* const font = ImGui::GetIO().Fonts->Fonts[kLargeFont];
  const float width = font->CalcTextSizeA(font->FontSize, 1e6F, 0.0F, stage.c_str()).x;
  ImGui::SameLine(ImGui::GetWindowWidth() - width - ImGui::GetStyle().WindowPadding.x);
  large(stage);
}

void draw_progress(const session::SessionStatus& status, float density) {
  const bool is_begun = status.trial > 0 && status.of > 0;
  const std::string words = is_begun ? fmt::format("trial {} of {}", status.trial, status.of)
                                     : std::string("no trial yet");
  const float share =
      is_begun ? static_cast<float>(status.trial) / static_cast<float>(status.of) : 0.0F;
  ImGui::TextUnformatted(words.c_str());
  ImGui::ProgressBar(std::min(share, 1.0F), {-1.0F, 10.0F * density}, "");
}

/// The participant's comfort stop, until it is settled.
void draw_stop(const session::SessionStatus& status) {
  if (!status.participant_stopped) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kVermillion);
  large("The participant has stopped the force");
  ImGui::PopStyleColor();
  ImGui::TextWrapped("%s", stop_advice(status).c_str());
}

void fact(const char* name, const std::string& value) {
  ImGui::TableNextColumn();
  // The name is closer to its value than to the row above.
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 2.0F});
  grey(name);
  ImGui::PopStyleVar();
  ImGui::TextWrapped("%s", value.c_str());
}

/// The three levels side by side, with the present one marked; all grey while there is none.
void level(const char* name, std::optional<session::HandLevel> now) {
  using session::HandLevel;
  ImGui::TableNextColumn();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 2.0F});
  grey(name);
  ImGui::PopStyleVar();
  const float pad = 0.35F * ImGui::GetFontSize();
  ImDrawList* const drawing = ImGui::GetWindowDrawList();
  ImVec2 at = ImGui::GetCursorScreenPos();
  at.x -= pad;  // the words are in line with those below
  for (const HandLevel one : {HandLevel::low, HandLevel::right, HandLevel::high}) {
    const char* const word = level_word(one);
    const ImVec2 size = ImGui::CalcTextSize(word);
    const bool is_now = one == now;
    if (is_now) {
      drawing->AddRectFilled({at.x, at.y - 1.0F},
                             {at.x + size.x + 2.0F * pad, at.y + size.y + 1.0F}, kBlue, 0.5F * pad);
    }
    drawing->AddText({at.x + pad, at.y}, is_now ? kWhite : kGrey, word);
    at.x += size.x + 2.0F * pad;
  }
  ImGui::Dummy({0.0F, ImGui::GetTextLineHeight()});
}

std::optional<session::HandLevel> level_of(const std::optional<session::HandLevels>& hand,
                                           session::HandLevel session::HandLevels::*which) {
  if (!hand) return std::nullopt;
  return (*hand).*which;
}

void draw_facts(const session::SessionStatus& status) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(status.elapsed).count();
  const bool is_measured = status.rate_hz > 0.0;
  if (!ImGui::BeginTable("facts", 3)) return;
  level("force", level_of(status.hand, &session::HandLevels::force));
  level("speed", level_of(status.hand, &session::HandLevels::speed));
  fact("elapsed", fmt::format("{}:{:02}", seconds / 60, seconds % 60));
  fact("interruptions", std::to_string(status.interruptions));
  fact("device", status.device.empty() ? "-" : status.device);
  fact("servo rate", is_measured ? fmt::format("{:.0f} per s", status.rate_hz) : "-");
  fact("lateness, 99 %", is_measured ? fmt::format("{:.0f} us", status.lateness_p99_us) : "-");
  fact("overruns", is_measured ? std::to_string(status.overruns) : "-");
  ImGui::EndTable();
}

bool coloured_button(const char* label, PackedColour colour, ImVec2 size) {
  for (const ImGuiCol part : {ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive}) {
    ImGui::PushStyleColor(part, colour);
  }
  ImGui::PushStyleColor(ImGuiCol_Text, kWhite);
  const bool pressed = ImGui::Button(label, size);
  ImGui::PopStyleColor(4);
  return pressed;
}

bool button(const char* label, ImVec2 size, bool is_enabled = true) {
  ImGui::BeginDisabled(!is_enabled);
  const bool pressed = ImGui::Button(label, size);
  ImGui::EndDisabled();
  return pressed;
}

std::string words_of(const session::ExperimenterRequest& request) {
  switch (request.kind) {
    case Kind::pause:
      return "pause";
    case Kind::resume:
      return "resume";
    case Kind::comfort_stop:
      return "comfort stop";
    case Kind::note:
      return "note: " + request.text;
    case Kind::deviation:
      return "deviation " + request.code + (request.text.empty() ? "" : ": " + request.text);
    case Kind::abort:
      return "end of the session" + (request.text.empty() ? "" : ": " + request.text);
    case Kind::leave:
      break;
  }
  return "";
}

}  // namespace

void ConsolePanel::draw(const session::SessionStatus& status, Vec2 size, float density,
                        bool may_write) {
  const Look look(density);
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize(imgui_vec(size));
  ImGui::Begin("console", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  draw_heading(status);
  draw_progress(status, density);
  draw_stop(status);
  ImGui::Spacing();
  draw_facts(status);
  ImGui::Spacing();
  draw_buttons(status, density);
  ImGui::Spacing();
  is_writing_ = false;
  draw_draft(density, may_write);
  draw_asked();
  ImGui::End();
}

void ConsolePanel::draw_buttons(const session::SessionStatus& status, float density) {
  const float third =
      (ImGui::GetContentRegionAvail().x - 2.0F * ImGui::GetStyle().ItemSpacing.x) / 3.0F;
  const ImVec2 size = {third, kButtonHeight * density};
  const bool is_paused = status.stage == kPaused;
  if (button("Pause", size, !is_paused)) {
    ask(Kind::pause);
    begin(Draft::pause_reason);
  }
  ImGui::SameLine();
  if (button("Resume", size, is_paused)) ask(Kind::resume);
  ImGui::SameLine();
  if (coloured_button("Comfort stop", kVermillion, size)) {
    ask(Kind::comfort_stop);
    begin(Draft::stop_reason);
  }
  if (button("Note", size)) begin(Draft::note);
  ImGui::SameLine();
  if (button("Deviation", size)) begin(Draft::deviation);
  ImGui::SameLine();
  if (button("Abort", size)) begin(Draft::abort);
}

void ConsolePanel::draw_draft(float density, bool may_write) {
  if (draft_ == Draft::none) return;
  const ImVec2 size = {150.0F * density, 0.0F};
  static constexpr std::array<const char*, 6> kAsks = {
      "",
      "Paused. The reason, if it should be noted:",
      "Stopped. The reason, which must say nothing about the texture:",
      "Note:",
      "Deviation: its code, and what was different:",
      "Abort: ends this session for good; it cannot be resumed. The reason:"};
  ImGui::TextUnformatted(kAsks[static_cast<std::size_t>(draft_)]);
  bool is_sent = false;
  ImGui::BeginDisabled(!may_write);
  if (draft_ == Draft::deviation) {
    ImGui::SetNextItemWidth(220.0F * density);
    if (is_begun_ && may_write) ImGui::SetKeyboardFocusHere();
    ImGui::InputTextWithHint("##code", "code", code_.data(), code_.size());
    is_writing_ = is_writing_ || ImGui::IsItemActive();
    ImGui::SameLine();
    draw_codes();
    ImGui::SameLine();
  }
  ImGui::SetNextItemWidth(-1.0F);
  if (is_begun_ && may_write && draft_ != Draft::deviation) ImGui::SetKeyboardFocusHere();
  is_sent = ImGui::InputTextWithHint("##text", "in words", text_.data(), text_.size(),
                                     ImGuiInputTextFlags_EnterReturnsTrue);
  is_writing_ = is_writing_ || ImGui::IsItemActive();
  ImGui::EndDisabled();
  is_begun_ = false;
  // After the plane, the experimenter selects the field again: the next keys may be an answer.
  if (is_writing_ && !may_write) ImGui::SetWindowFocus(nullptr);
  is_writing_ = is_writing_ && may_write;
  // Enter does not end a session.
  if (draft_ == Draft::abort) {
    is_sent = coloured_button("End the session", kVermillion, size);
  } else {
    is_sent = ImGui::Button("Enter it", size) || is_sent;
  }
  ImGui::SameLine();
  const bool is_left = ImGui::Button(draft_ == Draft::abort ? "Go on" : "Discard it", size);
  if (!may_write) {
    ImGui::SameLine();
    grey("A plane is on: the keyboard is the participant's.");
  }
  if (is_sent) send();
  if (is_left) draft_ = Draft::none;
}

/// The program's codes, from which one can be taken into the field.
void ConsolePanel::draw_codes() {
  if (!ImGui::BeginCombo("##codes", "", ImGuiComboFlags_NoPreview | ImGuiComboFlags_HeightLarge)) {
    return;
  }
  for (const std::string_view code : design::kDeviationCodes) {
    if (!ImGui::Selectable(std::string(code).c_str())) continue;
    code_.fill('\0');
    std::copy(code.begin(), code.end(), code_.begin());
  }
  ImGui::EndCombo();
}

void ConsolePanel::draw_asked() {
  if (asked_.empty()) return;
  ImGui::Spacing();
  grey("requests to the session, newest first");
  for (const std::string& words : asked_) ImGui::TextWrapped("%s", words.c_str());
}

void ConsolePanel::begin(Draft draft) {
  draft_ = draft;
  is_begun_ = true;
  text_.fill('\0');
  code_.fill('\0');
}

void ConsolePanel::send() {
  const std::string text = text_.data();
  const std::string code = code_.data();
  const bool is_missing = draft_ == Draft::deviation ? code.empty() : text.empty();
  if (is_missing && (draft_ == Draft::deviation || draft_ == Draft::note)) return;
  const Draft sent = std::exchange(draft_, Draft::none);
  if (sent == Draft::abort) return ask(Kind::abort, text);
  if (sent == Draft::deviation) return ask(Kind::deviation, text, code);
  if (text.empty()) return;
  if (sent == Draft::pause_reason) return ask(Kind::note, "pause: " + text);
  if (sent == Draft::stop_reason) return ask(Kind::deviation, text, session::kComfortStopCode);
  ask(Kind::note, text);
}

void ConsolePanel::ask(Kind kind, const std::string& text, const std::string& code) {
  const session::ExperimenterRequest request{kind, text, code};
  asked_.push_front(words_of(request));
  if (asked_.size() > kAskedShown) asked_.pop_back();
  ask_(request);
}

}  // namespace touchtrial::app
