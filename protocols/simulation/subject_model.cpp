#include "protocols/simulation/subject_model.hpp"

#include "core/errors.hpp"
#include "core/nearest_name.hpp"
#include "core/strict_json.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"

#include <algorithm>

namespace touchtrial::simulation {
namespace {

/// Refuses a label that the study does not have.
/// \param pointer  the label's place in the subject file
void check_label(const std::string& label, const std::string& pointer, const std::string& source,
                 const std::vector<std::string_view>& labels) {
  if (std::ranges::find(labels, label) != labels.end()) return;
  const auto nearest = nearest_name(label, labels);
  throw StudyError(one_line(source + ": " + pointer + ": the study has no class " +
                            in_quotes(label) + "; " +
                            (nearest ? "did you mean " + in_quotes(*nearest) + "?"
                                     : "use labels of the study's classes")));
}

}  // namespace

std::string recorded_device(const SubjectModel& model) {
  return model.given_function ? "given-function" : device::simulated_device_name(model.device);
}

void SubjectModel::check_labels(const study::Study& study) const {
  std::vector<std::string_view> labels;
  for (const study::StudyClass& study_class : study.classes) labels.emplace_back(study_class.label);
  for (std::size_t i = 0; i < class_bias.size(); ++i) {
    const std::string pointer = "/bias/classes/" + std::to_string(i) + "/label";
    check_label(class_bias[i].label, pointer, source, labels);
  }
  for (std::size_t i = 0; i < label_swap.size(); ++i) {
    const std::string pointer = "/label_swap/" + std::to_string(i);
    check_label(label_swap[i].first, pointer + "/0", source, labels);
    check_label(label_swap[i].second, pointer + "/1", source, labels);
  }
}

}  // namespace touchtrial::simulation
