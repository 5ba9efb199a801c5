/// The study file's "registration".
#include "protocols/design/study_sections.hpp"
#include "protocols/design/study_texts.hpp"

namespace touchtrial::design {
namespace {

constexpr std::size_t kLongestStatement = 4000;  // bytes
constexpr int kMostParticipants = 100'000;

void read_statement(const JsonObject& object, std::string_view key, std::string& statement) {
  if (const auto member = object.find(key)) statement = read_paragraphs(*member, kLongestStatement);
}

}  // namespace

Registration read_registration(const JsonValue& place) {
  const JsonObject object =
      place.object({"hypothesis", "participants", "stopping_rule", "exclusions", "primary_test"});
  Registration registration;
  read_statement(object, "hypothesis", registration.hypothesis);
  if (const auto member = object.find("participants")) {
    registration.participants = static_cast<int>(member->integer(0, kMostParticipants));
  }
  read_statement(object, "stopping_rule", registration.stopping_rule);
  read_statement(object, "exclusions", registration.exclusions);
  read_statement(object, "primary_test", registration.primary_test);
  return registration;
}

nlohmann::json to_json(const Registration& registration) {
  return {{"hypothesis", registration.hypothesis},
          {"participants", registration.participants},
          {"stopping_rule", registration.stopping_rule},
          {"exclusions", registration.exclusions},
          {"primary_test", registration.primary_test}};
}

}  // namespace touchtrial::design
