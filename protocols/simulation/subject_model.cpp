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
                 const std::vector<std::string_view>& known) {
  if (std::ranges::find(known, label) != known.end()) return;
  const auto nearest = nearest_name(label, known);
  throw StudyError(one_line(source + ": " + pointer + ": the study has no class " +
                            in_quotes(label) + "; " +
                            (nearest ? "did you mean " + in_quotes(*nearest) + "?"
                                     : "use labels of the study's classes")));
}

}  // namespace

std::string recorded_device(const SubjectModel& model) {
  return model.given_function ? "given-function" : device::words_of_simulated(model.device);
}

void SubjectModel::check_labels(const study::Study& study) const {
  std::vector<std::string_view> known;
  for (const study::StudyClass& study_class : study.classes) known.emplace_back(study_class.label);
  for (std::size_t i = 0; i < class_bias.size(); ++i) {
    const std::string pointer = "/bias/classes/" + std::to_string(i) + "/label";
    check_label(class_bias[i].label, pointer, source, known);
  }
  for (std::size_t i = 0; i < label_swap.size(); ++i) {
    const std::string pointer = "/label_swap/" + std::to_string(i);
    check_label(label_swap[i].first, pointer + "/0", source, known);
    check_label(label_swap[i].second, pointer + "/1", source, known);
  }
}

}  // namespace touchtrial::simulation
