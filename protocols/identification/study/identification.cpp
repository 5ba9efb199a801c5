#include "protocols/identification/study/identification.hpp"

#include "protocols/identification/study/block_order.hpp"
#include "protocols/identification/study/schedule.hpp"
#include "study/study.hpp"

namespace touchtrial::study::identification {
namespace {

/// The common part of both protocols, which differ only in the methods that they present.
class Identification : public Protocol {
 public:
  void check(const JsonValue& file, const Study& study) const override {
    if (const auto obstacle = obstacle_to_order(study)) {
      file.refuse_below("/trials" + obstacle->key, obstacle->what);
    }
  }
  int scored_trials(const Study& study) const override {
    return static_cast<int>(study.classes.size()) * study.presented_methods() *
           study.trials.repeats;
  }
  Schedule schedule(const Study& study, const ScheduleDraw& draw) const override {
    return scheduled(study, draw);
  }
  std::string rule(const Study& study) const override { return rule_of_schedule(study); }
  std::vector<Presentation> restarted_block(const Study& study, const ScheduleDraw& draw, int block,
                                            int restarts_before, int first_trial) const override {
    return scheduled_again(study, draw, block, restarts_before, first_trial);
  }
  std::vector<Choice> choices(const Study& study) const override {
    std::vector<Choice> classes;
    for (const StudyClass& one : study.classes) {
      classes.push_back({one.label, static_cast<int>(classes.size())});
    }
    return classes;
  }
  std::optional<int> right_choice(const Study&, const Presentation& shown) const override {
    return shown.stimulus.class_index;
  }
  bool may_name_one_key(const Study& /*study*/) const override { return true; }
};

class Classification final : public Identification {
 public:
  std::string_view name() const noexcept override { return "classification"; }
  bool presents_all_methods() const noexcept override { return false; }
};

class Comparison final : public Identification {
 public:
  std::string_view name() const noexcept override { return "comparison"; }
  int least_methods() const noexcept override { return 2; }
  void check(const JsonValue& file, const Study& study) const override {
    if (study.methods.size() < 2) {
      file.refuse_below("/methods",
                        "has 1 entry; the protocol comparison needs at least 2: add one, or choose "
                        "the protocol classification");
    }
    Identification::check(file, study);
  }
};

}  // namespace

const Protocol& classification() {
  static const Classification protocol;
  return protocol;
}

const Protocol& comparison() {
  static const Comparison protocol;
  return protocol;
}

}  // namespace touchtrial::study::identification
