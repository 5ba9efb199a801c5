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

/// Light, like the participant's window.
class Look {
 public:
  explicit Look(float density) {
    ImGui::StyleColorsLight();
    colour(ImGuiCol_Text, kTextColour);
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

/// The pending comfort stop of the participant.
void draw_stop(const session::SessionStatus& status) {
  if (!status.participant_stopped) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kVermillion);
  large("The participant has stopped the force");
  ImGui::PopStyleColor();
  ImGui::TextWrapped("%s", stop_advice(status).c_str());
}

void draw_alert(const session::SessionStatus& status) {
  if (status.alert.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kVermillion);
  ImGui::TextWrapped("%s", status.alert.c_str());
  ImGui::PopStyleColor();
}

void fact(const char* name, const std::string& value) {
  ImGui::TableNextColumn();
  // Spacing that places a name closer to its value than to the row above.
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 2.0F});
  grey(name);
  ImGui::PopStyleVar();
  ImGui::TextWrapped("%s", value.c_str());
}

/// The three levels side by side, with the current one marked; all grey without a level.
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

void draw_asked(const ExperimenterView& view) {
  if (view.asked.empty()) return;
  ImGui::Spacing();
  grey("requests to the session, newest first");
  for (const std::string& words : view.asked) ImGui::TextWrapped("%s", words.c_str());
}

}  // namespace

void ConsolePanel::draw(Vec2 size, float density, bool may_write) {
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
  is_writing_ = false;
  if (!view.need.empty()) ImGui::TextWrapped("%s", view.need.c_str());
  draw_question(view, density, may_write);
  draw_asked(view);
  ImGui::End();
  // An action or answer in this frame may have started another line.
  const ExperimenterView now = desk_.view();
  if (now.questions != questions_) wants_keyboard_ = true;
  if (!may_write || now.question.kind != Kind::text) wants_keyboard_ = false;
  is_writing_ = is_writing_ || is_settling();
}

void ConsolePanel::draw_actions(const ExperimenterView& view, float density) {
  constexpr std::size_t kColumns = 4;
  const float gaps = static_cast<float>(kColumns - 1) * ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size = {(ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(kColumns),
                       kConsoleButtonHeight * density};
  for (std::size_t i = 0; i < kExperimenterActions.size(); ++i) {
    const ExperimenterAction& action = kExperimenterActions[i];
    if (i % kColumns != 0) ImGui::SameLine();
    const bool is_stop = action.what == ExperimenterAction::What::comfort_stop;
    const bool is_pressed = is_stop ? coloured_button(action.label, kVermillion, size)
                                    : button(action.label, size, view.allows(action.what));
    if (is_pressed) desk_.act(action.what);
  }
}

void ConsolePanel::draw_question(const ExperimenterView& view, float density, bool may_write) {
  if (std::exchange(questions_, view.questions) != view.questions) {
    wants_keyboard_ = true;
    text_.fill('\0');
  }
  const ExperimenterQuestion& question = view.question;
  if (question.kind == Kind::none) return;
  ImGui::TextWrapped("%s%s", question.text.c_str(), question.is_own() ? ":" : "");
  const ImVec2 size = {150.0F * density, 0.0F};
  if (question.kind == Kind::text) {
    bool is_sent = draw_line(question, density, may_write);
    is_sent = ImGui::Button("Enter it", size) || is_sent;
    if (is_sent) desk_.answer(text_.data());
  } else if (question.kind == Kind::sure) {
    const ExperimenterQuestion::Choice& choice = question.choices.front();
    if (coloured_button(choice.label.c_str(), kVermillion, size)) desk_.answer(choice.answer);
  } else {
    return draw_choices(question);
  }
  ImGui::SameLine();
  if (ImGui::Button("Discard it", size)) desk_.discard();
  if (question.kind == Kind::text && !may_write) {
    ImGui::SameLine();
    grey("A plane is on: the keyboard is the participant's.");
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

bool ConsolePanel::draw_line(const ExperimenterQuestion& question, float density, bool may_write) {
  ImGui::BeginDisabled(!may_write);
  // Each line is a separate field, which can take the focus from the previous one.
  ImGui::PushID(static_cast<int>(questions_));
  // Room for the list of suggestions beside it.
  ImGui::SetNextItemWidth(question.choices.empty() ? -1.0F : -50.0F * density);
  if (wants_keyboard_ && may_write) ImGui::SetKeyboardFocusHere();
  const bool is_ended =
      ImGui::InputText("##text", text_.data(), text_.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  is_writing_ = ImGui::IsItemActive();
  if (is_writing_) wants_keyboard_ = false;
  if (!question.choices.empty()) {
    ImGui::SameLine();
    draw_suggestions(question, text_);
  }
  ImGui::PopID();
  ImGui::EndDisabled();
  // After a plane, the experimenter must select the field again, because the next keys may be the
  // participant's answer.
  if (is_writing_ && !may_write) ImGui::SetWindowFocus(nullptr);
  is_writing_ = is_writing_ && may_write;
  return is_ended;
}

}  // namespace touchtrial::app
