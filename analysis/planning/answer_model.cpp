#include "analysis/planning/answer_model.hpp"

#include "analysis/planning/noise_lines.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/own_knowledge.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace touchtrial::planning {
namespace {

constexpr int kAcuityGroups = 8;
constexpr int kThresholdGroups = 4;
/// Each stimulus's explorations are split into this many tasks, whose sums are added in a fixed
/// order.
constexpr int kPieces = 4;

/// The biases that a layout adds to the supports of the pictures.
struct LayoutBias {
  std::vector<double> class_log_odds;  ///< of each class, the same for all people
  std::vector<double> nearness;        ///< of each class's picture to the first position
};

std::vector<LayoutBias> biases(const simulation::SubjectModel& subject,
                               const std::vector<std::string>& classes,
                               std::span<const PictureLayout> layouts) {
  std::vector<LayoutBias> all;
  for (const PictureLayout& layout : layouts) {
    LayoutBias bias{std::vector<double>(classes.size()), nearness_of(layout)};
    for (std::size_t c = 0; c < classes.size(); ++c) {
      bias.class_log_odds[c] = subject.position_bias * bias.nearness[c];
      for (const simulation::ClassBias& preferred : subject.class_bias) {
        if (preferred.label == classes[c]) bias.class_log_odds[c] += preferred.log_odds;
      }
    }
    all.push_back(std::move(bias));
  }
  return all;
}

/// The bias of each prototype's picture, by layout and prototype.
std::vector<std::vector<double>> prototype_biases(const std::vector<LayoutBias>& layouts,
                                                  const std::vector<int>& pictures) {
  std::vector<std::vector<double>> biases;
  for (const LayoutBias& layout : layouts) {
    std::vector<double>& row = biases.emplace_back();
    for (const int picture : pictures) row.push_back(layout.class_log_odds[picture]);
  }
  return biases;
}

/// Scales independent standard normals to a vector of length 1.
void set_direction(std::span<const double> normals, std::vector<double>& direction) {
  double square = 0.0;
  for (std::size_t n = 0; n < direction.size(); ++n) square += normals[n] * normals[n];
  for (std::size_t n = 0; n < direction.size(); ++n) {
    direction[n] = normals[n] / std::sqrt(square);
  }
}

std::size_t index_of_class(const std::vector<std::string>& classes, const std::string& label) {
  const auto found = std::ranges::find(classes, label);
  if (found == classes.end()) {
    throw std::invalid_argument("AnswerModel: the study has no class of this name: " + label);
  }
  return static_cast<std::size_t>(found - classes.begin());
}

/// Converts the pieces' sums to probabilities that include lapses.
void normalise_answers(std::span<const AnswerTable> pieces, int row, double lapse,
                       std::span<double> answers, std::span<double> slopes) {
  for (const AnswerTable& piece : pieces) {
    for (std::size_t c = 0; c < answers.size(); ++c) answers[c] += piece.answers(row, 0)[c];
    for (std::size_t c = 0; c < slopes.size(); ++c) slopes[c] += piece.slopes(row, 0)[c];
  }
  double total = 0.0;
  for (const double value : answers) total += value;
  const double chance = 1.0 / static_cast<double>(answers.size());
  for (double& value : answers) value = lapse * chance + (1.0 - lapse) * value / total;
  for (double& value : slopes) value *= (1.0 - lapse) / total;
}

/// The groups of a noise line's simulated person, each equally likely.
struct PersonGroup {
  std::uint8_t acuity;
  std::uint8_t threshold;
};

/// The supports for each group of people in a subject model; one group if people do not differ.
class GroupSupports {
 public:
  GroupSupports(const simulation::SubjectModel& subject,
                const simulation::FeltKnowledge& knowledge) {
    const bool thresholds_differ = subject.sense && subject.threshold_spread_db > 0.0;
    acuities_ = normal_groups(subject.feature_noise_spread > 0.0 ? kAcuityGroups : 1);
    thresholds_ = normal_groups(thresholds_differ ? kThresholdGroups : 1);
    for (const double acuity : acuities_) {
      const double factor = std::exp(subject.feature_noise_spread * acuity);
      const engine::FeltNoise noise{subject.feature_noise * factor, subject.common_noise * factor};
      for (const double shift : thresholds_) {
        std::optional<simulation::FeltFloor> floor;
        if (subject.sense) floor = simulation::floor_of(noise, subject.threshold_spread_db * shift);
        supports_.emplace_back(knowledge, noise, floor);
      }
    }
  }

  [[nodiscard]] const LinearSupports& supports_of(PersonGroup person) const noexcept {
    const std::size_t acuity = acuities_.size() > 1 ? person.acuity : 0;
    const std::size_t threshold = thresholds_.size() > 1 ? person.threshold : 0;
    return supports_[acuity * thresholds_.size() + threshold];
  }

 private:
  std::vector<double> acuities_;
  std::vector<double> thresholds_;
  std::vector<LinearSupports> supports_;
};

}  // namespace

std::vector<double> nearness_of(const PictureLayout& layout) {
  std::vector<double> nearness(layout.size(), 0.0);
  const double last_index = std::max(1.0, static_cast<double>(layout.size()) - 1.0);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    nearness[layout[i]] = 1.0 - static_cast<double>(i) / last_index;
  }
  return nearness;
}

double mean_lapse(const simulation::SubjectModel& subject) {
  if (subject.lapse_spread == 0.0 || subject.lapse <= 0.0 || subject.lapse >= 1.0) {
    return subject.lapse;
  }
  constexpr int kGroups = 32;
  static const std::vector<double> groups = normal_groups(kGroups);
  const double median = std::log(subject.lapse / (1.0 - subject.lapse));
  double sum = 0.0;
  for (const double z : groups) sum += 1.0 / (1.0 + std::exp(-median - subject.lapse_spread * z));
  return sum / kGroups;
}

AnswerTable::AnswerTable(int layouts, int stimuli, int classes, bool with_slopes)
    : stimuli_(stimuli), classes_(classes) {
  const auto cells = static_cast<std::size_t>(layouts) * stimuli * classes;
  answers_.assign(cells, 0.0);
  if (with_slopes) slopes_.assign(cells * classes, 0.0);
}

struct AnswerModel::State {
  State(const simulation::FeltKnowledge& felt_knowledge, const simulation::FeltBank& bank,
        std::vector<std::string> labels, const AnswerModelOptions& model_options);

  /// Adds all noise lines of one piece of a stimulus's explorations, in every layout.
  void add_piece(int place, int piece, const simulation::SubjectModel& subject,
                 const GroupSupports& groups, const std::vector<LayoutBias>& layouts, BankPart part,
                 AnswerTable& sums) const;
  void add_preferences(const simulation::SubjectModel& subject, std::span<const double> numbers,
                       const LayoutBias& layout, const std::vector<int>& pictures,
                       std::vector<double>& supports) const;
  [[nodiscard]] std::vector<int> pictures_of(const simulation::SubjectModel& subject) const;

  simulation::FeltKnowledge knowledge;
  std::vector<std::string> classes;
  AnswerModelOptions options;
  std::vector<study::StimulusIndex> stimuli;
  std::vector<std::vector<engine::FeltFeatures>> felt;  ///< by stimulus
  std::vector<NoisePoints> points;                      ///< by stimulus
  std::vector<std::vector<PersonGroup>> person_groups;  ///< by stimulus and noise line
  int dimensions;                                       ///< of noise
  RadialDistribution radial;
};

AnswerModel::State::State(const simulation::FeltKnowledge& felt_knowledge,
                          const simulation::FeltBank& bank, std::vector<std::string> labels,
                          const AnswerModelOptions& model_options)
    : knowledge(felt_knowledge),
      classes(std::move(labels)),
      options(model_options),
      dimensions(noise_dimensions(static_cast<int>(felt_knowledge.label_of_prototype.size()))),
      radial(dimensions) {
  if (options.directions < 1 || options.jobs < 1) {
    throw std::invalid_argument("AnswerModel: directions and jobs must be at least 1");
  }
  // A point holds the noise, then numbers of a person: position bias, class biases, acuity.
  const int numbers = dimensions + 2 + static_cast<int>(classes.size());
  for (int place = 0; place < bank.stimuli(); ++place) {
    const std::span<const engine::FeltFeatures> explorations = bank.felt(place);
    stimuli.push_back(bank.stimulus(place));
    felt.emplace_back(explorations.begin(), explorations.end());
    points.emplace_back(numbers, explorations.size() * static_cast<std::size_t>(options.directions),
                        options.seed, static_cast<std::uint64_t>(place));
    RandomStream thresholds(options.seed, "answer model: thresholds",
                            static_cast<std::uint64_t>(place));
    auto& groups = person_groups.emplace_back();
    for (std::size_t i = 0; i < explorations.size() * static_cast<std::size_t>(options.directions);
         ++i) {
      const double z = points.back().point(i).back();
      const double share = 0.5 * std::erfc(-z / std::numbers::sqrt2);
      const int acuity = std::min(kAcuityGroups - 1, static_cast<int>(share * kAcuityGroups));
      groups.push_back({static_cast<std::uint8_t>(acuity),
                        static_cast<std::uint8_t>(thresholds.below(kThresholdGroups))});
    }
  }
}

std::vector<int> AnswerModel::State::pictures_of(const simulation::SubjectModel& subject) const {
  std::vector<int> picture_of_class(classes.size());
  for (std::size_t c = 0; c < classes.size(); ++c) picture_of_class[c] = static_cast<int>(c);
  for (const auto& [first, second] : subject.label_swap) {
    std::swap(picture_of_class[index_of_class(classes, first)],
              picture_of_class[index_of_class(classes, second)]);
  }
  std::vector<int> pictures;
  for (const std::string& label : knowledge.label_of_prototype) {
    pictures.push_back(picture_of_class[index_of_class(classes, label)]);
  }
  return pictures;
}

/// Adds the individual preferences of the simulated person of one noise line.
void AnswerModel::State::add_preferences(const simulation::SubjectModel& subject,
                                         std::span<const double> numbers, const LayoutBias& layout,
                                         const std::vector<int>& pictures,
                                         std::vector<double>& supports) const {
  const auto person_numbers = numbers.subspan(static_cast<std::size_t>(dimensions));
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const auto picture = static_cast<std::size_t>(pictures[k]);
    supports[k] += subject.position_bias_spread * person_numbers[0] * layout.nearness[picture] +
                   subject.class_bias_spread * person_numbers[1 + picture];
  }
}

void AnswerModel::State::add_piece(int place, int piece, const simulation::SubjectModel& subject,
                                   const GroupSupports& groups,
                                   const std::vector<LayoutBias>& layouts, BankPart part,
                                   AnswerTable& sums) const {
  const std::vector<int> pictures = pictures_of(subject);
  const auto prototypes = pictures.size();
  const auto directions = static_cast<std::size_t>(options.directions);
  const auto noise_numbers = static_cast<std::size_t>(dimensions);
  std::vector<double> felt_supports(prototypes), biased_supports(prototypes), slope(prototypes),
      direction(noise_numbers);
  const bool people_differ =
      subject.position_bias_spread != 0.0 || subject.class_bias_spread != 0.0;
  const std::vector<std::vector<double>> bias = prototype_biases(layouts, pictures);
  // Consecutive Sobol points are spread as evenly as the whole sequence.
  const std::size_t pieces = static_cast<std::size_t>(part.count) * kPieces;
  const std::size_t index = static_cast<std::size_t>(part.index) * kPieces + piece;
  const std::size_t end = felt[place].size() * (index + 1) / pieces;
  for (std::size_t i = felt[place].size() * index / pieces; i < end; ++i) {
    for (std::size_t j = 0; j < directions; ++j) {
      const std::size_t line = i * directions + j;
      const std::span<const double> numbers = points[place].point(line);
      const LinearSupports& supports = groups.supports_of(person_groups[place][line]);
      set_direction(numbers, direction);
      supports.compute_supports(felt[place][i], felt_supports);
      supports.compute_noise(direction, slope);
      for (std::size_t l = 0; l < layouts.size(); ++l) {
        for (std::size_t k = 0; k < prototypes; ++k)
          biased_supports[k] = felt_supports[k] + bias[l][k];
        if (people_differ) add_preferences(subject, numbers, layouts[l], pictures, biased_supports);
        add_winners(biased_supports, slope, pictures, radial, 1.0,
                    sums.answers(static_cast<int>(l), 0), sums.slopes(static_cast<int>(l), 0));
      }
    }
  }
}

AnswerModel::AnswerModel(const simulation::FeltKnowledge& knowledge,
                         const simulation::FeltBank& bank, std::vector<std::string> classes,
                         const AnswerModelOptions& options)
    : state_(std::make_unique<State>(knowledge, bank, std::move(classes), options)) {}
AnswerModel::~AnswerModel() = default;
AnswerModel::AnswerModel(AnswerModel&&) noexcept = default;

const std::vector<std::string>& AnswerModel::classes() const noexcept {
  return state_->classes;
}

const std::vector<study::StimulusIndex>& AnswerModel::stimuli() const noexcept {
  return state_->stimuli;
}

AnswerTable AnswerModel::answers(const simulation::SubjectModel& subject,
                                 std::span<const PictureLayout> layouts, bool with_slopes,
                                 BankPart part) const {
  const State& state = *state_;
  const auto classes = static_cast<int>(state.classes.size());
  const auto stimuli = static_cast<int>(state.stimuli.size());
  // Without a preference for positions, all layouts are alike.
  const bool same_in_all_layouts =
      subject.position_bias == 0.0 && subject.position_bias_spread == 0.0;
  const std::vector<LayoutBias> bias =
      biases(subject, state.classes, same_in_all_layouts ? layouts.first(1) : layouts);
  const auto rows = static_cast<int>(bias.size());
  const GroupSupports groups(subject, state.knowledge);
  const auto tasks = static_cast<std::size_t>(stimuli) * kPieces;
  std::vector<AnswerTable> sums(tasks, AnswerTable(rows, 1, classes, with_slopes));
  in_parallel(state.options.jobs, tasks, [&](std::size_t task) {
    state.add_piece(static_cast<int>(task / kPieces), static_cast<int>(task % kPieces), subject,
                    groups, bias, part, sums[task]);
  });
  AnswerTable table(static_cast<int>(layouts.size()), stimuli, classes, with_slopes);
  const double lapse = mean_lapse(subject);
  for (int place = 0; place < stimuli; ++place) {
    const std::span pieces(sums.data() + static_cast<std::size_t>(place) * kPieces, kPieces);
    for (int layout = 0; layout < static_cast<int>(layouts.size()); ++layout) {
      normalise_answers(pieces, same_in_all_layouts ? 0 : layout, lapse,
                        table.answers(layout, place), table.slopes(layout, place));
    }
  }
  return table;
}

AnswerModel answer_model_of(const study::StudyKey& key, const engine::Pack& pack,
                            const simulation::SubjectModel& subject,
                            const FeltStudyOptions& options, const study::Progress& progress) {
  subject.check_labels(key.study);
  const session::StimulusSource source(pack, key.study.rendering);
  const simulation::LabelledFields fields(key, source);
  const simulation::FeltKnowledge knowledge = simulation::learn_by_feeling(
      fields, subject, key.study.rendering.max_force_n, options.seed, options.jobs);
  const simulation::FeltBank bank(
      fields, key.study, subject,
      {.explorations = options.explorations, .seed = options.seed, .jobs = options.jobs}, progress);
  std::vector<std::string> classes;
  for (const study::StudyClass& study_class : key.study.classes) {
    classes.push_back(study_class.label);
  }
  return {knowledge,
          bank,
          std::move(classes),
          {.directions = options.directions, .seed = options.seed, .jobs = options.jobs}};
}

std::vector<study::StimulusIndex> stimuli_of(const study::StudyKey& key) {
  std::vector<study::StimulusIndex> stimuli;
  for (const study::KeyedStimulus& keyed : key.stimuli) stimuli.push_back(keyed.stimulus);
  std::ranges::sort(stimuli);
  return stimuli;
}

std::vector<PictureLayout> layouts_of(const study::Study& study, int participants) {
  std::vector<PictureLayout> layouts;
  const study::StudyKey key = study::simulated_study_key(study);
  for (int number = 1; number <= participants; ++number) {
    PictureLayout layout =
        study::make_schedule(study, key.draw_of(number, study::Draws::rehearsal)).layout;
    if (std::ranges::find(layouts, layout) == layouts.end()) layouts.push_back(std::move(layout));
  }
  return layouts;
}

}  // namespace touchtrial::planning
