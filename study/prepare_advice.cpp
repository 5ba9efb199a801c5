#include "study/prepare_advice.hpp"

#include "core/errors.hpp"
#include "core/labels.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <map>

namespace touchtrial::study {
namespace {

std::string image_in_words(const Study& study, int class_index, int exemplar) {
  const StudyClass& study_class = study.class_at(class_index);
  const auto& image = study_class.images[static_cast<std::size_t>(exemplar)];
  return one_line("class \"" + study_class.label + "\", image " + image.string());
}

}  // namespace

std::string stimulus_words(const Study& study, const StimulusIndex& stimulus) {
  const auto& method = study.methods[static_cast<std::size_t>(stimulus.method)];
  return image_in_words(study, stimulus.class_index, stimulus.exemplar) + ", method " +
         method.label;
}

std::vector<SkippedWork> skipped_work(const Study& study, std::uintmax_t pixels) {
  std::size_t images = 0;
  for (const StudyClass& study_class : study.classes) images += study_class.images.size();
  std::vector<SkippedWork> skipped;
  for (std::size_t m = static_cast<std::size_t>(study.presented_methods());
       m < study.methods.size(); ++m) {
    skipped.push_back({study.methods[m].label + " x " + std::to_string(images) + " stimuli",
                       "the " + study.protocol_name() +
                           " protocol presents only its first method, " +
                           study.methods.front().label,
                       pixels * sizeof(float)});
  }
  return skipped;
}

std::vector<std::string> rendering_warnings(const engine::RenderingOptions& rendering,
                                            const engine::StudyGains& gains) {
  std::vector<std::string> warnings;
  if (gains.over_budget) {
    warnings.push_back("/rendering/gains: the explicit gains exceed the stiffness budget of " +
                       number_text(rendering.texture_stiffness_n_per_mm) +
                       " N/mm, so devices may vibrate; lower them or set \"budget\"");
  }
  const auto is_zero = [](const engine::Gains& field_gains) {
    return field_gains == engine::Gains{};
  };
  if (!rendering.gains && std::ranges::all_of(gains.per_field, is_zero)) {
    warnings.emplace_back(
        "/rendering/gains: all gains are 0, so no texture can be felt: every picture is flat, or a "
        "side has fewer than 3 pixels, too few for a stiffness budget; use other pictures");
  }
  if (rendering.gains && rendering.equalise == engine::Equalise::rms) {
    warnings.emplace_back(
        "/rendering/equalise: rms has no effect on explicit gains; set gains to \"budget\"");
  }
  if (rendering.model == engine::ModelKind::paper && rendering.reference_grey == 0.0) {
    warnings.emplace_back(
        "/rendering/reference_grey: 0 is the paper's literal reading, with a step of force at the "
        "surface that makes the stylus bounce; 128 avoids the step");
  }
  return warnings;
}

std::vector<std::string> validity_warnings(const Study& study) {
  const ValidityRule& rule = study.trials.validity;
  const double limit_s = study.trials.explore_limit_s;
  std::vector<std::string> warnings;
  const auto warn = [&warnings](const std::string& key, const std::string& what) {
    warnings.push_back("/trials/validity/" + key + ": " + what +
                       ", so no trial can be valid; lower it, or change the study");
  };
  const auto warn_if_too_long = [&](const char* key, double min_s) {
    if (min_s <= limit_s) return;
    warn(key, number_text(min_s) + " s, but a presentation can be explored for only " +
                  number_text(limit_s) + " s (/trials/explore_limit_s)");
  };
  warn_if_too_long("exploring_s", rule.min_exploring_s);
  warn_if_too_long("contact_s", rule.min_contact_s);
  if (rule.min_path_mm > kMaxStrokeMmS * limit_s) {
    warn("path_mm", number_text(rule.min_path_mm) +
                        " mm, more than the fastest stroke of the instructions covers in " +
                        number_text(limit_s) + " s");
  }
  const double max_n = std::min(rule.max_median_n, study.rendering.max_force_n);
  if (rule.min_median_n > max_n) {
    warn("least_median_n", number_text(rule.min_median_n) + " N, but the force is limited to " +
                               number_text(max_n) + " N");
  }
  return warnings;
}

std::string solver_warning(const Study& study, const StimulusIndex& stimulus,
                           const BuiltField& built) {
  if (built.converged) return {};
  const auto& options = study.methods[static_cast<std::size_t>(stimulus.method)].tv_gabor;
  return stimulus_words(study, stimulus) + ": stopped after " + std::to_string(built.steps) +
         " steps at a relative gap of " + number_text(built.gap) + ", not " +
         number_text(options.gap) + "; raise max_steps";
}

std::vector<std::string> duplicate_warnings(const Study& study, std::span<const Digest> pixels) {
  std::vector<std::string> warnings;
  std::map<Digest, std::string> seen;
  std::size_t image = 0;
  for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) {
    const auto exemplars = study.classes[static_cast<std::size_t>(c)].images.size();
    for (int e = 0; e < static_cast<int>(exemplars); ++e) {
      const std::string words = image_in_words(study, c, e);
      const auto [first, is_new] = seen.emplace(pixels[image++], words);
      if (is_new) continue;
      warnings.push_back(words + ": has the same pixels as " + first->second +
                         ", so nobody can tell them apart; use another picture");
    }
  }
  return warnings;
}

std::string label_warning(const Study& study) {
  std::vector<std::string> labels;
  for (const StudyClass& study_class : study.classes) labels.push_back(study_class.label);
  const std::string remark = remark_on_alphabets(labels);
  return remark.empty() ? "" : "/classes: " + remark;
}

}  // namespace touchtrial::study
