#include "analysis/outcomes/collection_records.hpp"
#include "analysis/report/json_figures.hpp"

#include <map>
#include <set>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json prescription_json(const Prescription& prescription) {
  Json object{{"explore_limit_s", figure_json(prescription.explore_limit_s)},
              {"on_timeout", prescription.on_timeout},
              {"order", prescription.order},
              {"repeats", prescription.repeats},
              {"sight", prescription.sight},
              {"masking",
               {{"wanted", prescription.masking_wanted},
                {"level_dbfs", figure_json(prescription.masking_dbfs)}}}};
  if (prescription.visits > 1) object["visits"] = prescription.visits;
  if (!prescription.groups.empty()) object["groups"] = prescription.groups;
  return object;
}

Json flow_json(const ParticipantFlow& flow) {
  return {{"enrolled", flow.enrolled},
          {"erased", flow.erased},
          {"replaced", flow.replaced},
          {"excluded", flow.excluded},
          {"exclusion_reasons", flow.exclusion_reasons},
          {"stopped", flow.stopped},
          {"open", flow.open},
          {"other_kind", flow.other_kind},
          {"unseen", flow.unseen},
          {"analysed", flow.analysed},
          {"withdrawn", flow.withdrawn}};
}

Json practice_json(const std::optional<PracticeRecord>& practice) {
  if (!practice) return nullptr;
  return {{"rounds", practice->rounds},
          {"presentations", practice->presentations},
          {"correct", practice->correct ? Json(*practice->correct) : Json(nullptr)},
          {"passed", practice->passed}};
}

Json answers_json(const SessionRecord& session) {
  if (!session.answers) return nullptr;
  Json object{{"n", *session.answers}, {"one_key", session.one_key}};
  if (!session.spread) return object;
  object["different"] = session.spread->different;
  object["largest_share"] = figure_json(session.spread->largest_share);
  object["longest_run"] = session.spread->longest_run;
  object["median_s"] = figure_json(session.spread->median_s);
  return object;
}

Json session_json(const SessionRecord& session) {
  Json object{{"session", session.row.session}, {"state", name_of(session.row.state)}};
  object["withdrawn"] = session.row.withdrawn;
  object["erased"] = session.row.erased;
  if (session.row.erased) return object;
  object["participant"] = session.row.participant;
  if (session.row.visit > 1) object["visit"] = session.row.visit;
  if (!session.group.empty()) object["group"] = session.group;
  object["excluded"] = session.row.excluded;
  object["replaced_by"] = session.row.replaced_by;
  object["device"] = session.row.device;
  object["device_serial"] = session.device_serial;
  if (session.station && session.station->screen) {
    object["screen"] = {{"mm_per_px", figure_json(session.station->screen->mm_per_px)},
                        {"source", session.station->screen->source}};
  }
  object["practice"] = practice_json(session.practice);
  object["answers"] = answers_json(session);
  object["exclusion_reason"] = exclusion_words(session);
  object["replacement_reason"] = session.replacement_reason;
  object["stop_reason"] = session.stop_reason;
  object["withdrawal_reason"] = session.withdrawal_reason;
  object["largest_force_n"] = figure_json(session.largest_force_n);
  object["resumed"] = session.resumed;
  object["interruptions"] = session.interruptions;
  object["pauses"] = session.pauses;
  object["notes"] = session.notes;
  object["deviations"] = array_json(session.deviations, [](const Deviation& deviation) {
    return Json{{"code", deviation.code}, {"text", deviation.text}};
  });
  return object;
}

Json dates_json(const std::vector<SessionRecord>& sessions) {
  const auto dates = dates_of(sessions);
  return dates ? Json{{"first", dates->first}, {"last", dates->last}} : Json(nullptr);
}

/// The number of sessions with each deviation.
Json deviations_json(const Collection& collection) {
  std::map<std::string, int> sessions;
  for (const SessionRecord& session : collection.sessions) {
    std::set<std::string> codes;
    for (const Deviation& deviation : session.deviations) codes.insert(deviation.code);
    for (const std::string& code : codes) ++sessions[code];
  }
  return sessions;
}

}  // namespace

nlohmann::ordered_json collection_object(const Collection& collection) {
  Json sessions = Json::array();
  for (const SessionRecord& session : collection.sessions) {
    if (!collection.is_public) sessions.push_back(session_json(session));
  }
  Json looks = Json::array();
  for (const record::PersonLook& look : collection.looks) {
    if (collection.is_public) break;
    looks.push_back({{"participant", look.participant}, {"reason", look.reason}});
  }
  return {{"prescription", prescription_json(collection.prescription)},
          {"dates", dates_json(collection.sessions)},
          {"flow", flow_json(collection.flow)},
          {"looks", std::move(looks)},
          {"deviations", deviations_json(collection)},
          {"sessions", std::move(sessions)}};
}

}  // namespace touchtrial::analysis
