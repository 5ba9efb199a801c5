/// \file Small studies for the tests of this folder.
#pragma once

#include "core/errors.hpp"
#include "study/protocol.hpp"
#include "study/study.hpp"
#include "support/refusal.hpp"

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial {

/// The smallest study that is accepted: two classes of one image, one method.
[[nodiscard]] inline nlohmann::json minimal_study() {
  return {{"study", "small"},
          {"protocol", "classification"},
          {"classes",
           {{{"label", "rough"}, {"images", {"rough.png"}}},
            {{"label", "smooth"}, {"images", {"smooth.png"}}}}},
          {"methods", {{{"name", "adaptive"}}}}};
}

/// A study of `classes` classes c0, c1, .. with `images` images each.
[[nodiscard]] inline nlohmann::json study_of(int classes, int images = 1) {
  nlohmann::json study = minimal_study();
  study["classes"] = nlohmann::json::array();
  for (int c = 0; c < classes; ++c) {
    nlohmann::json paths = nlohmann::json::array();
    for (int e = 0; e < images; ++e) {
      paths.push_back("c" + std::to_string(c) + "_" + std::to_string(e) + ".png");
    }
    study["classes"].push_back({{"label", "c" + std::to_string(c)}, {"images", paths}});
  }
  return study;
}

/// The same as a comparison of adaptive and tv-gabor.
[[nodiscard]] inline nlohmann::json comparison_of(int classes, int images = 1) {
  nlohmann::json study = study_of(classes, images);
  study["protocol"] = "comparison";
  study["methods"] = {{{"name", "adaptive"}}, {{"name", "tv-gabor"}}};
  return study;
}

/// A study with practice and with a plan of the session and a registration that are not the
/// default.
[[nodiscard]] inline nlohmann::json planned_study() {
  nlohmann::json study = study_of(3);
  study.update(nlohmann::json::parse(R"({
    "trials": {"practice": 5},
    "practice": {"classes": [{"label": "corduroy", "images": ["corduroy.png"]},
                             {"label": "velvet", "images": ["velvet.png"]}]},
    "session": {"instructions": {"en": ["Feel the plane.\n\nSlowly."]}, "sight": "blindfold",
                "confidence": 5, "day_sheet": ["Door shut"], "consent_version": "form 3",
                "ethics_number": "2026-17",
                "closing_questions": [{"id": "cue", "kind": "choice", "text": {"en": "Which cue?"},
                                       "options": [{"en": "Edges"},
                                                   {"en": "Depth", "de": "Tiefe"}]}]},
    "registration": {"hypothesis": "They can.", "participants": 20}})"));
  return study;
}

[[nodiscard]] inline study::Study parsed(const nlohmann::json& study,
                                         const std::filesystem::path& folder = "somewhere") {
  return study::parse_study(study.dump(), folder, "study.json");
}

/// The error that a study is refused with; empty if it is accepted.
[[nodiscard]] inline std::string refusal_of(const nlohmann::json& study) {
  return message_of<StudyError>([&] { return parsed(study); });
}

/// Whether a study is refused at `places`.
[[nodiscard]] inline bool refused(const nlohmann::json& study, const std::string& places) {
  return refuses<StudyError>([&] { return parsed(study); }, places);
}

/// A participant's draw that follows from the study's seed, for tests of schedules alone.
[[nodiscard]] inline study::ScheduleDraw drawn(const study::Study& study, int number) {
  SeededEntropy entropy(study.seed);
  return {.secret = entropy.secret("test participant " + std::to_string(number)),
          .method_order = number};
}

[[nodiscard]] inline study::Schedule schedule_of(const study::Study& study, int number) {
  return study::make_schedule(study, drawn(study, number));
}

}  // namespace touchtrial
