#include "app/windows/experimenter/console_panel.hpp"

#include "app/windows/experimenter/status_words.hpp"
#include "app/windows/look.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

using Kind = ExperimenterQuestion::Kind;

constexpr PackedColour kTextColour = 0xFF202020;
constexpr PackedColour kGround = 0xFFF6F4F2;
constexpr float kMargin = 20.0F;
constexpr float kConsoleButtonHeight = 44.0F;

/// Applies the light style of the participant's window for its lifetime.
class Look {
 public:
  explicit Look(float density) {
    ImGui::StyleColorsLight();
    set_colour(ImGuiCol_Text, kTextColour);
    set_colour(ImGuiCol_WindowBg, kGround);
    set_colour(ImGuiCol_FrameBg, kWhite);
    set_colour(ImGuiCol_Button, kPale);
    set_colour(ImGuiCol_ButtonHovered, 0xFFD4D0CC);
    set_colour(ImGuiCol_ButtonActive, 0xFFC0BCB8);
    set_colour(ImGuiCol_PlotHistogram, kBlue);
    set_spacing(ImGuiStyleVar_WindowPadding, {kMargin * density, kMargin * density});
    set_spacing(ImGuiStyleVar_FramePadding, {12.0F * density, 9.0F * density});
    set_spacing(ImGuiStyleVar_CellPadding, {0.0F, 6.0F * density});
    set_spacing(ImGuiStyleVar_ItemSpacing, {10.0F * density, 10.0F * density});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 5.0F * density);
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1.0F);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    pushed_variables_ += 3;
  }
  ~Look() {
    ImGui::PopStyleVar(pushed_variables_);
    ImGui::PopStyleColor(pushed_colours_);
  }
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;

 private:
  void set_colour(ImGuiCol part, PackedColour value) {
    ImGui::PushStyleColor(part, value);
    ++pushed_colours_;
  }
  void set_spacing(ImGuiStyleVar part, ImVec2 value) {
    ImGui::PushStyleVar(part, value);
    ++pushed_variables_;
  }

  int pushed_colours_ = 0;
  int pushed_variables_ = 0;
};

void draw_large_text(const std::string& text) {
  ImGui::PushFont(ImGui::GetIO().Fonts->Fonts[kLargeFont]);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
}

void draw_grey_text(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
}

void draw_heading(const session::SessionStatus& status) {
  draw_large_text(status.participant.empty() ? "no session yet" : status.participant);
  std::string stage = status.stage;
  if (status.practice && status.stage != "practice") stage += " (practice)";
  ImFont* const font = ImGui::GetIO().Fonts->Fonts[kLargeFont];
  const float width = font->CalcTextSizeA(font->FontSize, 1e6F, 0.0F, stage.c_str()).x;
  ImGui::SameLine(ImGui::GetWindowWidth() - width - ImGui::GetStyle().WindowPadding.x);
  draw_large_text(stage);
}

void draw_progress(const session::SessionStatus& status, float density) {
  const bool has_trial = status.trial > 0 && status.total > 0;
  const std::string words = has_trial ? fmt::format("trial {} of {}", status.trial, status.total)
                                      : std::string("no trial yet");
  const float share =
      has_trial ? static_cast<float>(status.trial) / static_cast<float>(status.total) : 0.0F;
  ImGui::TextUnformatted(words.c_str());
  ImGui::ProgressBar(std::min(share, 1.0F), {-1.0F, 10.0F * density}, "");
}

/// The pending comfort stop of the participant.
void draw_stop(const session::SessionStatus& status) {
  if (!status.participant_stopped) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kVermillion);
  draw_large_text("The participant has stopped the force");
  ImGui::PopStyleColor();
  ImGui::TextWrapped("%s", stop_advice(status).c_str());
}

void draw_alert(const session::SessionStatus& status) {
  if (status.alert.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kVermillion);
  ImGui::TextWrapped("%s", status.alert.c_str());
  ImGui::PopStyleColor();
}

void draw_fact(const char* name, const std::string& value) {
  ImGui::TableNextColumn();
  // Spacing that places a name closer to its value than to the row above.
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 2.0F});
  draw_grey_text(name);
  ImGui::PopStyleVar();
  ImGui::TextWrapped("%s", value.c_str());
}

/// Draws the three levels side by side with the current one marked; all are grey without one.
void draw_level(const char* name, std::optional<session::HandLevel> current) {
  using session::HandLevel;
  ImGui::TableNextColumn();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 2.0F});
  draw_grey_text(name);
  ImGui::PopStyleVar();
  const float pad = 0.35F * ImGui::GetFontSize();
  ImDrawList* const drawing = ImGui::GetWindowDrawList();
  ImVec2 position = ImGui::GetCursorScreenPos();
  position.x -= pad;  // aligns the words with the text below
  for (const HandLevel hand_level : {HandLevel::low, HandLevel::right, HandLevel::high}) {
    const char* const word = level_word(hand_level);
    const ImVec2 size = ImGui::CalcTextSize(word);
    const bool is_current = hand_level == current;
    if (is_current) {
      drawing->AddRectFilled({position.x, position.y - 1.0F},
                             {position.x + size.x + 2.0F * pad, position.y + size.y + 1.0F}, kBlue,
                             0.5F * pad);
    }
    drawing->AddText({position.x + pad, position.y}, is_current ? kWhite : kGrey, word);
    position.x += size.x + 2.0F * pad;
  }
  ImGui::Dummy({0.0F, ImGui::GetTextLineHeight()});
}

std::optional<session::HandLevel> level_of(const std::optional<session::HandLevels>& hand,
                                           session::HandLevel session::HandLevels::*member) {
  if (!hand) return std::nullopt;
  return (*hand).*member;
}

void draw_facts(const session::SessionStatus& status) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(status.elapsed).count();
  const bool is_measured = status.rate_hz > 0.0;
  if (!ImGui::BeginTable("facts", 3)) return;
  draw_level("force", level_of(status.hand, &session::HandLevels::force));
  draw_level("speed", level_of(status.hand, &session::HandLevels::speed));
  draw_fact("elapsed", fmt::format("{}:{:02}", seconds / 60, seconds % 60));
  draw_fact("interruptions", std::to_string(status.interruptions));
  draw_fact("device", status.device.empty() ? "-" : status.device);
  draw_fact("servo rate", is_measured ? fmt::format("{:.0f} per s", status.rate_hz) : "-");
  draw_fact("lateness, 99 %", is_measured ? fmt::format("{:.0f} us", status.lateness_p99_us) : "-");
  draw_fact("overruns", is_measured ? std::to_string(status.overruns) : "-");
  ImGui::EndTable();
}

bool coloured_button(const char* label, PackedColour colour, ImVec2 size) {
  for (const ImGuiCol part : {ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive}) {
    ImGui::PushStyleColor(part, colour);
  }
  ImGui::PushStyleColor(ImGuiCol_Text, kWhite);
  const bool is_pressed = ImGui::Button(label, size);
  ImGui::PopStyleColor(4);
  return is_pressed;
}

bool button(const char* label, ImVec2 size, bool is_enabled = true) {
  ImGui::BeginDisabled(!is_enabled);
  const bool is_pressed = ImGui::Button(label, size);
  ImGui::EndDisabled();
  return is_pressed;
}

/// A list of suggestions for the field.
void draw_suggestions(const ExperimenterQuestion& question, std::array<char, 501>& text) {
  if (!ImGui::BeginCombo("##choices", "",
                         ImGuiComboFlags_NoPreview | ImGuiComboFlags_HeightLarge)) {
    return;
  }
  for (const ExperimenterQuestion::Choice& choice : question.choices) {
    if (!ImGui::Selectable(choice.answer.c_str())) continue;
    text.fill('\0');
    std::ranges::copy(choice.answer, text.begin());
  }
  ImGui::EndCombo();
}

void draw_requests(const ExperimenterView& view) {
  if (view.requests.empty()) return;
  ImGui::Spacing();
  draw_grey_text("requests to the session, newest first");
  for (const std::string& words : view.requests) ImGui::TextWrapped("%s", words.c_str());
}

}  // namespace

void ConsolePanel::draw(Vec2 size, float density, bool has_keyboard) {
  const ExperimenterView view = desk_.view();
  const Look look(density);
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize(imgui_vec(size));
  ImGui::Begin("console", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  draw_heading(view.status);
  draw_progress(view.status, density);
  draw_stop(view.status);
  draw_alert(view.status);
  ImGui::Spacing();
  draw_facts(view.status);
  ImGui::Spacing();
  draw_actions(view, density);
  ImGui::Spacing();
  is_typing_ = false;
  if (!view.need.empty()) ImGui::TextWrapped("%s", view.need.c_str());
  draw_question(view, density, has_keyboard);
  draw_requests(view);
  ImGui::End();
  // An action or answer in this frame may have opened another question.
  const ExperimenterView updated_view = desk_.view();
  if (updated_view.question_number != question_number_) is_focus_pending_ = true;
  if (!has_keyboard || updated_view.question.kind != Kind::text) is_focus_pending_ = false;
  is_typing_ = is_typing_ || is_focus_pending();
}

void ConsolePanel::draw_actions(const ExperimenterView& view, float density) {
  constexpr std::size_t kColumns = 4;
  const float gaps = static_cast<float>(kColumns - 1) * ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size = {(ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(kColumns),
                       kConsoleButtonHeight * density};
  for (std::size_t i = 0; i < kExperimenterActions.size(); ++i) {
    const ExperimenterAction& action = kExperimenterActions[i];
    if (i % kColumns != 0) ImGui::SameLine();
    const bool is_stop = action.kind == ExperimenterAction::Kind::comfort_stop;
    const bool is_pressed = is_stop ? coloured_button(action.label, kVermillion, size)
                                    : button(action.label, size, view.allows(action.kind));
    if (is_pressed) desk_.act(action.kind);
  }
}

void ConsolePanel::draw_question(const ExperimenterView& view, float density, bool has_keyboard) {
  if (std::exchange(question_number_, view.question_number) != view.question_number) {
    is_focus_pending_ = true;
    text_.fill('\0');
  }
  const ExperimenterQuestion& question = view.question;
  if (question.kind == Kind::none) return;
  ImGui::TextWrapped("%s%s", question.text.c_str(), question.is_from_experimenter() ? ":" : "");
  const ImVec2 size = {150.0F * density, 0.0F};
  if (question.kind == Kind::text) {
    bool is_sent = draw_text_field(question, density, has_keyboard);
    is_sent = ImGui::Button("Enter", size) || is_sent;
    if (is_sent) desk_.answer(text_.data());
  } else if (question.kind == Kind::confirm) {
    const ExperimenterQuestion::Choice& choice = question.choices.front();
    if (coloured_button(choice.label.c_str(), kVermillion, size)) desk_.answer(choice.answer);
  } else {
    return draw_choices(question);
  }
  ImGui::SameLine();
  if (ImGui::Button("Discard", size)) desk_.discard();
  if (question.kind == Kind::text && !has_keyboard) {
    ImGui::SameLine();
    draw_grey_text("The keyboard belongs to the participant while a plane is on.");
  }
}

void ConsolePanel::draw_choices(const ExperimenterQuestion& question) {
  const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
  const ImGuiStyle& style = ImGui::GetStyle();
  for (std::size_t i = 0; i < question.choices.size(); ++i) {
    const auto& [answer, label, key] = question.choices[i];
    const char* const words = label.empty() ? answer.c_str() : label.c_str();
    const float width = ImGui::CalcTextSize(words).x + 2.0F * style.FramePadding.x;
    const float end = ImGui::GetItemRectMax().x + style.ItemSpacing.x + width;
    if (i > 0 && end < right) ImGui::SameLine();
    if (ImGui::Button(words)) desk_.answer(answer);
  }
}

bool ConsolePanel::draw_text_field(const ExperimenterQuestion& question, float density,
                                   bool has_keyboard) {
  ImGui::BeginDisabled(!has_keyboard);
  // A separate field per question, which can take the focus from the previous one.
  ImGui::PushID(static_cast<int>(question_number_));
  // Leaves room for the list of suggestions.
  ImGui::SetNextItemWidth(question.choices.empty() ? -1.0F : -50.0F * density);
  if (is_focus_pending_ && has_keyboard) ImGui::SetKeyboardFocusHere();
  const bool is_ended =
      ImGui::InputText("##text", text_.data(), text_.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  is_typing_ = ImGui::IsItemActive();
  if (is_typing_) is_focus_pending_ = false;
  if (!question.choices.empty()) {
    ImGui::SameLine();
    draw_suggestions(question, text_);
  }
  ImGui::PopID();
  ImGui::EndDisabled();
  // After a plane, the experimenter must select the field again, because the participant may answer
  // with the next keys.
  if (is_typing_ && !has_keyboard) ImGui::SetWindowFocus(nullptr);
  is_typing_ = is_typing_ && has_keyboard;
  return is_ended;
}

}  // namespace touchtrial::app
