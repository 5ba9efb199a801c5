#include "study/protocol.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

namespace touchtrial::study {
namespace {

std::vector<const Protocol*>& known_protocols() {
  static std::vector<const Protocol*> all;
  return all;
}

}  // namespace

std::shared_ptr<const ProtocolOptions> Protocol::read(const std::optional<JsonValue>&) const {
  return nullptr;
}

std::string Protocol::options_in_clear(const Study&) const {
  return {};
}

std::vector<Presentation> Protocol::restarted_block(const Study& study, const ScheduleDraw& draw,
                                                    int block, int restarts_before,
                                                    int first_trial) const {
  std::vector<Presentation> again;
  for (const Presentation& shown : schedule(study, draw).presentations) {
    if (shown.block == block) again.push_back(shown);
  }
  if (again.empty() || restarts_before < 0) {
    throw std::invalid_argument("restarted_block: the study has no such block or restart");
  }
  RandomStream random(draw.secret, "schedule: block " + std::to_string(block) + ", restart " +
                                       std::to_string(restarts_before + 1));
  shuffle(std::span<Presentation>(again), random);
  for (Presentation& shown : again) shown.trial = first_trial++;
  return again;
}

void add_protocol(const Protocol& protocol) {
  auto& all = known_protocols();
  if (find_protocol(protocol.name()) != nullptr) {
    throw std::invalid_argument("add_protocol: there are two protocols " +
                                std::string(protocol.name()));
  }
  all.push_back(&protocol);
}

const std::vector<const Protocol*>& protocols() {
  return known_protocols();
}

const Protocol* find_protocol(std::string_view name) {
  const auto& all = protocols();
  const auto found = std::ranges::find(all, name, &Protocol::name);
  return found == all.end() ? nullptr : *found;
}

bool chooses_classes(const Study& study) {
  const std::vector<Choice> choices = study.protocol->choices(study);
  if (choices.size() != study.classes.size()) return false;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i].class_index != static_cast<int>(i)) return false;
  }
  return true;
}

void require_choice_of_classes(const Study& study, const std::string& command) {
  if (chooses_classes(study)) return;
  throw StudyError(one_line("study " + study.name + ": " + command +
                            " needs participants who choose between the study's classes, which the "
                            "protocol " +
                            study.protocol_name() + " does not ask; give a study of another"));
}

Schedule make_schedule(const Study& study, const ScheduleDraw& draw) {
  return study.protocol->schedule(study, draw);
}

std::vector<Presentation> restarted_block(const Study& study, const ScheduleDraw& draw, int block,
                                          int restarts_before, int first_trial) {
  return study.protocol->restarted_block(study, draw, block, restarts_before, first_trial);
}

double drawn_rove_db(double range_db, RandomStream& random) {
  return range_db * (random.uniform() - 0.5);
}

std::unique_ptr<AdaptiveOrder> adaptive_order(const Study& study, const ScheduleDraw& draw) {
  return study.protocol->adaptive_order(study, draw);
}

std::string schedule_rule(const Study& study) {
  return study.protocol->rule(study);
}

}  // namespace touchtrial::study
