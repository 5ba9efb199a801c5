#include "analysis/planning/changes_words.hpp"

#include "core/strict_json.hpp"

#include <vector>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

using simulation::SubjectModel;
using simulation::Training;

std::string words_of_training(const SubjectModel& subject) {
  std::string words;
  if (subject.training == Training::own) words += ", each by a training of their own";
  if (subject.training == Training::none) {
    return fmt::format(", untrained, mapping noise {}", number_text(subject.mapping_noise));
  }
  if (subject.memory_noise > 0.0) words += ", memory noise " + number_text(subject.memory_noise);
  return words;
}

bool learns(const SubjectModel& subject) {
  return subject.learning.factor > 1.0;
}

bool tires(const SubjectModel& subject) {
  return subject.fatigue.noise_per_min > 0.0 || subject.fatigue.lapse_per_min > 0.0;
}

}  // namespace

std::string words_of_changes(const SubjectModel& subject) {
  std::string words = words_of_training(subject);
  if (learns(subject)) {
    words += fmt::format(
        ", noise at first {} times as large (spread {}), over {} trials, {} "
        "forgotten between visits",
        number_text(subject.learning.factor), number_text(subject.learning.spread),
        number_text(subject.learning.trials), number_text(subject.learning.forgotten));
  }
  if (subject.period_noise_spread > 0.0) {
    words += ", period noise spread " + number_text(subject.period_noise_spread);
  }
  if (const simulation::SerialDependence& serial = subject.serial; serial.is_on()) {
    words += fmt::format(
        ", leans on the last answer by {} (spread {}) and stimulus by {} (spread "
        "{})",
        number_text(serial.answer), number_text(serial.answer_spread), number_text(serial.stimulus),
        number_text(serial.stimulus_spread));
  }
  if (tires(subject)) {
    words += fmt::format(", tires by {} (lapses {}) a minute, of which a break takes {} away",
                         number_text(subject.fatigue.noise_per_min),
                         number_text(subject.fatigue.lapse_per_min),
                         number_text(subject.fatigue.recovered));
  }
  if (subject.thought) words += ", thinks longer about hard trials (without effect on power)";
  return words;
}

std::string keys_that_fits_ignore(const SubjectModel& subject) {
  std::vector<std::string> keys;
  if (subject.training == Training::own) keys.emplace_back("training");
  if (subject.training != Training::none && subject.memory_noise > 0.0) {
    keys.emplace_back("memory_noise");
  }
  if (subject.training == Training::none && subject.mapping_noise > 0.0) {
    keys.emplace_back("mapping_noise");
  }
  if (learns(subject)) keys.emplace_back("learning");
  if (subject.period_noise_spread > 0.0) keys.emplace_back("period_noise_spread");
  if (subject.serial.is_on()) keys.emplace_back("serial");
  if (tires(subject)) keys.emplace_back("fatigue");
  return fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace touchtrial::planning
