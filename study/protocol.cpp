#include "study/protocol.hpp"

#include "core/errors.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace touchtrial::study {
namespace {

std::vector<const Protocol*>& registered_protocols() {
  static std::vector<const Protocol*> all;
  return all;
}

}  // namespace

Fields Task::fields(const Study& study) const {
  Fields fields{.methods = study.methods};
  if (study.trials.practice == 0) return fields;
  for (std::size_t i = 0; i < study.practice.classes.size(); ++i) {
    fields.practice.push_back({.class_index = static_cast<int>(study.classes.size() + i)});
  }
  return fields;
}

void add_protocol(const Protocol& protocol) {
  auto& all = registered_protocols();
  if (find_protocol(protocol.name) != nullptr) {
    throw std::invalid_argument("add_protocol: the name is already registered: " +
                                std::string(protocol.name));
  }
  all.push_back(&protocol);
}

const std::vector<const Protocol*>& protocols() {
  return registered_protocols();
}

const Protocol* find_protocol(std::string_view name) {
  const auto& all = protocols();
  const auto found = std::ranges::find(all, name, &Protocol::name);
  return found == all.end() ? nullptr : *found;
}

std::string picture_of(const Study& study, const Trial& trial) {
  return trial.picture ? study.class_at(*trial.picture).label : "";
}

bool chooses_classes(const Study& study) {
  const std::vector<Choice> choices = choices_of(study);
  if (choices.size() != study.classes.size()) return false;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i].class_index != static_cast<int>(i)) return false;
  }
  return true;
}

void require_choice_of_classes(const Study& study, const std::string& command) {
  if (chooses_classes(study)) return;
  throw StudyError(one_line("study " + study.name + ": " + command +
                            " needs a question that lets participants choose between the study's "
                            "classes, which the protocol " +
                            study.protocol_name() +
                            " does not ask; use a study with another protocol"));
}

std::unique_ptr<Order> make_order(const Study& study, const ScheduleDraw& draw) {
  return study.task->order(study, draw);
}

Schedule make_schedule(const Study& study, const ScheduleDraw& draw) {
  return make_order(study, draw)->schedule();
}

TrialQuestion trial_question_of(const Study& study) {
  return study.task->ask(study, Place{.trial = 1});
}

std::vector<Choice> choices_of(const Study& study) {
  return trial_question_of(study).choices();
}

std::vector<StimulusIndex> presented_fields(const Study& study) {
  std::vector<StimulusIndex> fields;
  for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) {
    const auto images = static_cast<int>(study.class_at(c).images.size());
    for (int e = 0; e < images; ++e) {
      for (int m = 0; m < study.presented_methods(); ++m) fields.push_back({c, e, m});
    }
  }
  std::ranges::copy(study.task->fields(study).practice, std::back_inserter(fields));
  return fields;
}

std::string place_of_image(const Study& study, const StimulusIndex& field) {
  const bool is_practice = study.is_practice_class(field.class_index);
  const int first_class = is_practice ? static_cast<int>(study.classes.size()) : 0;
  return (is_practice ? "/practice/classes/" : "/classes/") +
         std::to_string(field.class_index - first_class) + "/images/" +
         std::to_string(field.exemplar);
}

Practice practice_of(const Study& study, const ScheduleDraw& draw, int round) {
  return study.task->practice(study, draw, round);
}

}  // namespace touchtrial::study
