#include "protocols/session/session_stages.hpp"

#include "protocols/session/practice_run.hpp"
#include "protocols/session/questionnaire_json.hpp"

#include <vector>

namespace touchtrial::session {
namespace {

// In virtual time; people take the time that they take.
constexpr std::chrono::seconds kCalibration{30};
constexpr std::chrono::seconds kInstruction{120};

/// A step that is shown again if somebody broke it off. \return nothing if the session ended
std::optional<StepReply> insist(SessionDesk& desk, const Step& step) {
  while (desk.goes_on()) {
    if (std::optional<StepReply> reply = desk.attend(step)) {
      desk.parts().clock.pass(reply->took);
      return reply;
    }
  }
  return std::nullopt;
}

std::vector<DaySheetItem> open_items(const SessionDesk& desk, const SessionRemarks& remarks) {
  std::vector<DaySheetItem> items;
  for (const DaySheetItem& item : desk.parts().texts.day_sheet) {
    if (!remarks.ticked.contains(item.code) && !remarks.deviations.contains(item.code)) {
      items.push_back(item);
    }
  }
  return items;
}

void record_ticks(SessionDesk& desk, const std::vector<DaySheetItem>& items,
                  const std::vector<Tick>& ticks) {
  for (std::size_t i = 0; i < items.size() && i < ticks.size(); ++i) {
    if (ticks[i] == Tick::done) {
      desk.session().tick(desk.now(), items[i].code);
    } else {
      desk.session().deviate(desk.now(), {items[i].code, "skipped on the day sheet"});
    }
  }
}

bool go_through_day_sheet(SessionDesk& desk) {
  const std::vector<DaySheetItem> items = open_items(desk, desk.session().remarks());
  if (items.empty()) return true;
  desk.enter("day sheet");
  while (desk.obey()) {
    if (const auto ticks = desk.parts().experimenter.day_sheet(items)) {
      record_ticks(desk, items, *ticks);
      return true;
    }
  }
  return false;
}

bool calibrate(SessionDesk& desk) {
  if (!go_through_day_sheet(desk)) return false;
  while (!desk.await_device()) {
    if (!desk.goes_on()) return false;
  }
  desk.parts().clock.pass(kCalibration);
  desk.session().calibrate(desk.now());
  return true;
}

bool instruct(SessionDesk& desk) {
  desk.enter("instructions");
  const std::vector<std::string>& pages = desk.parts().texts.instructions;
  if (!pages.empty() && !insist(desk, InstructionStep{pages})) return false;
  desk.parts().clock.pass(kInstruction);
  desk.session().instruct(desk.now());
  return true;
}

bool ask(SessionDesk& desk, const std::optional<design::Questionnaire>& questionnaire) {
  if (!questionnaire) return true;
  if (desk.session().remarks().questionnaires.contains(questionnaire->name)) return true;
  desk.enter("questions");
  const std::optional<StepReply> reply = insist(desk, QuestionStep{&*questionnaire});
  if (!reply) return false;
  desk.session().question(desk.when(*reply), questionnaire->name,
                          answers_to_json(*questionnaire, reply->answers));
  return true;
}

bool practise(SessionDesk& desk) {
  const PracticeTextures* textures = desk.parts().practice;
  const bool wanted = textures != nullptr && desk.parts().key.study.trials.practice > 0;
  if (!wanted || desk.session().presentations_begun() > 0) return true;
  return PracticeRun(desk, *textures).run();
}

void show_pictures(SessionDesk& desk) {
  std::vector<std::string> pictures;
  for (const int class_index : desk.session().layout()) {
    pictures.push_back(desk.parts().key.study.classes[class_index].label);
  }
  desk.parts().participant.see_pictures(pictures);
}

}  // namespace

bool run_opening_stages(SessionDesk& desk) {
  const Session& session = desk.session();
  if (session.phase() == SessionPhase::opened && !calibrate(desk)) return false;
  if (session.phase() == SessionPhase::calibrated && !instruct(desk)) return false;
  if (session.phase() == SessionPhase::ready) {
    if (!ask(desk, desk.parts().texts.handedness) || !practise(desk)) return false;
    show_pictures(desk);
  }
  return desk.goes_on();
}

void ask_closing_questions(SessionDesk& desk) {
  // Broken off, they are left out: what counts is stored.
  static_cast<void>(ask(desk, desk.parts().texts.closing));
}

}  // namespace touchtrial::session
