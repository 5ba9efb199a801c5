#include "analysis/choices/people_report.hpp"

#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"

#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::choices {
namespace {

using Json = nlohmann::ordered_json;
using analysis::plain_figure;
using analysis::share_figure;

Json counts_json(const Proportion& of) {
  const std::optional<double> share = of.share();
  return {{"n", of.n}, {"right", of.correct}, {"share", share ? Json(*share) : Json(nullptr)}};
}

Json json_of(const GlobalNullResult& anybody) {
  return {{"found", anybody.found()}, {"p", anybody.p},
          {"deals", anybody.deals},   {"people", anybody.people},
          {"alone", anybody.alone},   {"alone_by_chance", anybody.alone_by_chance}};
}

Json json_of(const Preference& one, const std::vector<std::string>& labels) {
  return {{"participant", one.participant},
          {"n", one.answers},
          {"preferred", labels.at(static_cast<std::size_t>(one.choice))},
          {"place", one.place ? Json(*one.place) : Json(nullptr)},
          {"named", one.named},
          {"right_there", counts_json(one.right_there)},
          {"right_elsewhere", counts_json(one.right_elsewhere)},
          {"p", one.p},
          {"p_holm", one.p_holm}};
}

}  // namespace

std::string alone_words(const GlobalNullResult& anybody) {
  return fmt::format("{} of {} {} an own p of {} or less, where chance gives {} at most on average",
                     anybody.alone, counted(anybody.people, "participant"),
                     anybody.people == 1 ? "has" : "have", analysis::kUsualLevel,
                     plain_figure(anybody.alone_by_chance, 1));
}

std::string preference_words(const Preferences& preferences,
                             const std::vector<std::string>& labels) {
  if (!preferences.anybody.found()) return "";
  std::string text = alone_words(preferences.anybody);
  const std::vector<const Preference*> found = preferences.of_those_who_prefer();
  if (found.empty()) return text + ": who they are cannot be determined";
  Proportion there;
  Proportion elsewhere;
  std::map<int, std::vector<std::string>> names;
  for (const Preference* one : found) {
    there += one->right_there;
    elsewhere += one->right_elsewhere;
    names[one->choice].push_back(one->participant);
  }
  std::vector<std::string> groups;
  for (const auto& [choice, people] : names) {
    groups.push_back(fmt::format("\"{}\" by {} ({})", labels.at(static_cast<std::size_t>(choice)),
                                 people.size(), listed(people)));
  }
  return text + fmt::format(
                    ". Preferred are {}. These people were right in {} of trials where what they "
                    "prefer was "
                    "right, and in {} of the others",
                    listed(groups, " and "), share_figure(there.share()),
                    share_figure(elsewhere.share()));
}

std::string preferences_sentence(const Preferences& preferences,
                                 const std::vector<std::string>& labels) {
  const std::string who = preference_words(preferences, labels);
  return fmt::format("Preferences of single participants ({}, global test over participants): {}.",
                     analysis::p_phrase(preferences.anybody.p), who.empty() ? "none found" : who);
}

std::string global_null_json(const GlobalNullResult& anybody) {
  return json_of(anybody).dump();
}

std::string preferences_json(const Preferences& preferences,
                             const std::vector<std::string>& labels) {
  Json object{{"anybody", json_of(preferences.anybody)},
              {"those_who_prefer", Json::array()},
              {"participants", Json::array()}};
  for (const Preference* one : preferences.of_those_who_prefer()) {
    object["those_who_prefer"].push_back(one->participant);
  }
  for (const Preference& one : preferences.people) {
    object["participants"].push_back(json_of(one, labels));
  }
  return object.dump();
}

}  // namespace touchtrial::choices
