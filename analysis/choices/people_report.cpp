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

Json counts_json(const Proportion& answers) {
  const std::optional<double> share = answers.share();
  return {{"n", answers.n},
          {"right", answers.correct},
          {"share", share ? Json(*share) : Json(nullptr)}};
}

Json json_of(const GlobalNullResult& global_null) {
  return {{"found", global_null.found()}, {"p", global_null.p},
          {"deals", global_null.deals},   {"people", global_null.people},
          {"alone", global_null.alone},   {"alone_by_chance", global_null.alone_by_chance}};
}

Json json_of(const Preference& preference, const std::vector<std::string>& labels) {
  return {{"participant", preference.participant},
          {"n", preference.answers},
          {"preferred", labels.at(static_cast<std::size_t>(preference.choice))},
          {"place", preference.place ? Json(*preference.place) : Json(nullptr)},
          {"named", preference.named_count},
          {"right_there", counts_json(preference.right_there)},
          {"right_elsewhere", counts_json(preference.right_elsewhere)},
          {"p", preference.p},
          {"p_holm", preference.p_holm}};
}

}  // namespace

std::string individual_p_words(const GlobalNullResult& global_null) {
  return fmt::format(
      "{} of {} {} an individual p of {} or less, where chance gives {} at most on average",
      global_null.alone, counted(global_null.people, "participant"),
      global_null.people == 1 ? "has" : "have", analysis::kUsualLevel,
      plain_figure(global_null.alone_by_chance, 1));
}

std::string preference_words(const Preferences& preferences,
                             const std::vector<std::string>& labels) {
  if (!preferences.global_null.found()) return "";
  std::string text = individual_p_words(preferences.global_null);
  const std::vector<const Preference*> preferring_people = preferences.people_with_preference();
  if (preferring_people.empty()) return text + ": who they are cannot be determined";
  Proportion right_there;
  Proportion right_elsewhere;
  std::map<int, std::vector<std::string>> names;
  for (const Preference* preference : preferring_people) {
    right_there += preference->right_there;
    right_elsewhere += preference->right_elsewhere;
    names[preference->choice].push_back(preference->participant);
  }
  std::vector<std::string> groups;
  for (const auto& [choice, people] : names) {
    groups.push_back(fmt::format("\"{}\" by {} ({})", labels.at(static_cast<std::size_t>(choice)),
                                 people.size(), listed(people)));
  }
  return text + fmt::format(
                    ". Preferred are {}. These people were right in {} of trials where their "
                    "preferred choice was right, and in {} of the others",
                    listed(groups, " and "), share_figure(right_there.share()),
                    share_figure(right_elsewhere.share()));
}

std::string preferences_sentence(const Preferences& preferences,
                                 const std::vector<std::string>& labels) {
  const std::string preferred = preference_words(preferences, labels);
  return fmt::format("Preferences of single participants ({}, global test over participants): {}.",
                     analysis::p_phrase(preferences.global_null.p),
                     preferred.empty() ? "none found" : preferred);
}

std::string global_null_json(const GlobalNullResult& global_null) {
  return json_of(global_null).dump();
}

std::string preferences_json(const Preferences& preferences,
                             const std::vector<std::string>& labels) {
  Json object{{"anybody", json_of(preferences.global_null)},
              {"those_who_prefer", Json::array()},
              {"participants", Json::array()}};
  for (const Preference* preference : preferences.people_with_preference()) {
    object["those_who_prefer"].push_back(preference->participant);
  }
  for (const Preference& preference : preferences.people) {
    object["participants"].push_back(json_of(preference, labels));
  }
  return object.dump();
}

}  // namespace touchtrial::choices
