#include "analysis/exports/export_tables.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/report/results.hpp"
#include "app/commands/simulated_study.hpp"
#include "app/commands/study_inputs.hpp"
#include "core/errors.hpp"
#include "python/arrays.hpp"
#include "python/module.hpp"
#include "study/key_protection.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace touchtrial::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

/// Supplies the passphrase of protected keys during its lifetime. Only one may exist at a time,
/// because the prompt and the opened keys are global to the process.
class Passphrase {
 public:
  explicit Passphrase(std::optional<std::string> passphrase) : lock_(passphrase_mutex()) {
    study::set_passphrase_prompt(
        [passphrase = std::move(passphrase)](const fs::path&, int attempt) {
          return attempt == 1 ? passphrase : std::nullopt;
        });
  }
  ~Passphrase() { study::set_passphrase_prompt({}); }
  Passphrase(const Passphrase&) = delete;
  Passphrase& operator=(const Passphrase&) = delete;

 private:
  static std::mutex& passphrase_mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
};

record::StudyStore open_unblinded(const std::string& database) {
  record::StudyStore store =
      record::StudyStore::open(database, record::StudyStore::Access::read_only);
  const record::StudyState state = store.state();
  if (state.unblinded) return store;
  throw StoreError(one_line(fs::path(database).filename().string()) + ": is " +
                   app::blind_words(state) +
                   ", so its outcomes are not shown; run `touchtrial close` and `touchtrial "
                   "unblind`");
}

/// An unblinded study with its outcomes. Its functions may be called by several threads.
class Study {
 public:
  Study(const std::string& database, const fs::path& key)
      : store_(open_unblinded(database)),
        key_(app::key_of_database(store_, database, key)),
        outcomes_(app::outcomes_of(store_, key_)),
        keys_(analysis::person_keys(store_, key_)) {}

  [[nodiscard]] const analysis::Outcomes& outcomes() const { return outcomes_; }

  /// The output of `report --json`.
  [[nodiscard]] std::string report() const {
    const std::lock_guard lock(store_mutex_);
    const analysis::TraceSource traces{store_, key_};
    return app::with_levels(
               analysis::analysis_of(outcomes_.design).results(outcomes_, {.source = &traces}),
               key_)
        ->json();
  }

  /// The tables of `export --format csv`, without the consents.
  [[nodiscard]] std::vector<analysis::ResultTable> tables() const {
    const std::lock_guard lock(store_mutex_);
    return analysis::exported_tables(store_, outcomes_);
  }

  /// \throws std::out_of_range if the study does not show such a trial
  [[nodiscard]] record::Trace trace(int session, int trial) const {
    const auto match =
        std::ranges::find_if(outcomes_.trials, [&](const analysis::TrialOutcome& outcome) {
          return outcome.row.session == session && outcome.row.trial == trial;
        });
    if (match == outcomes_.trials.end()) {
      throw std::out_of_range("the outcomes contain no trial " + std::to_string(trial) +
                              " of session " + std::to_string(session));
    }
    const std::lock_guard lock(store_mutex_);
    return analysis::open_trace(store_.sealed_trace(session, trial), match->row, keys_);
  }

 private:
  record::StudyStore store_;
  study::StudyKey key_;
  analysis::Outcomes outcomes_;
  analysis::SessionKeys keys_;
  mutable std::mutex store_mutex_;
};

std::unique_ptr<Study> read(const std::string& database, const fs::path& key,
                            const std::optional<std::string>& passphrase) {
  const py::gil_scoped_release gil_released;
  const Passphrase prompt(passphrase);
  return std::make_unique<Study>(database, key);
}

struct CellToPython {
  py::object operator()(std::monostate) const { return py::none(); }
  py::object operator()(const std::string& text) const {
    return py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
        text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape"));
  }
  py::object operator()(std::int64_t number) const { return py::int_(number); }
  py::object operator()(double number) const { return py::float_(number); }
  py::object operator()(std::chrono::nanoseconds time) const {
    return py::float_(std::chrono::duration<double>(time).count());
  }
};

struct CellToNumber {
  double operator()(std::monostate) const { return std::numeric_limits<double>::quiet_NaN(); }
  double operator()(const std::string&) const { return 0.0; }
  double operator()(std::int64_t number) const { return static_cast<double>(number); }
  double operator()(double number) const { return number; }
  double operator()(std::chrono::nanoseconds time) const {
    return std::chrono::duration<double>(time).count();
  }
};

/// int64 for whole numbers, float64 for other numbers or with missing ones, otherwise objects.
py::object column_of(const analysis::DataTable& table, std::size_t column) {
  const auto all_cells = [&](auto condition) {
    return std::ranges::all_of(table.rows, [&](const auto& row) { return condition(row[column]); });
  };
  if (all_cells([](const auto& cell) { return std::holds_alternative<std::int64_t>(cell); })) {
    std::vector<std::int64_t> numbers;
    for (const auto& row : table.rows) numbers.push_back(std::get<std::int64_t>(row[column]));
    return py::array_t<std::int64_t>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  }
  if (all_cells([](const auto& cell) { return !std::holds_alternative<std::string>(cell); })) {
    std::vector<double> numbers;
    for (const auto& row : table.rows) numbers.push_back(std::visit(CellToNumber{}, row[column]));
    return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
  }
  const auto numpy = py::module_::import("numpy");
  py::object objects = numpy.attr("empty")(table.rows.size(), py::arg("dtype") = "object");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    objects[py::int_(i)] = std::visit(CellToPython{}, table.rows[i][column]);
  }
  return objects;
}

py::dict tables_of(const Study& study) {
  const std::vector<analysis::ResultTable> tables = [&] {
    const py::gil_scoped_release gil_released;
    return study.tables();
  }();
  py::dict by_name;
  for (const analysis::ResultTable& result : tables) {
    py::dict columns;
    for (std::size_t i = 0; i < result.table.columns.size(); ++i) {
      columns[result.table.columns[i].c_str()] = column_of(result.table, i);
    }
    by_name[fs::path(result.file).stem().c_str()] = columns;
  }
  return by_name;
}

/// The rate, and an array (N, 6) that owns the samples.
py::tuple trace_of(const Study& study, int session, int trial) {
  record::Trace trace = [&] {
    const py::gil_scoped_release gil_released;
    return study.trace(session, trial);
  }();
  static_assert(sizeof(record::TraceSample) == 6 * sizeof(double));
  const auto [samples, base] = owned_by_python(std::move(trace.samples));
  const auto* first = samples->empty() ? nullptr : &samples->front().position_mm.x;
  return py::make_tuple(trace.rate_hz,
                        py::array_t<double>({samples->size(), std::size_t{6}}, first, base));
}

/// \param jobs  threads; 0: one per core
std::string simulate(const fs::path& study, const fs::path& database, int participants,
                     std::uint64_t seed, const fs::path& subject, const std::string& hand_device,
                     int jobs, int first_participant, bool keep_blind) {
  const py::gil_scoped_release gil_released;
  if (jobs == 0) jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const app::StudyToSimulate request{.study = study,
                                     .database = database,
                                     .subject = subject,
                                     .hand_device = hand_device,
                                     .options = {.participants = participants,
                                                 .seed = seed,
                                                 .jobs = jobs,
                                                 .first_participant = first_participant},
                                     .keep_blind = keep_blind};
  return app::simulation_json(request, app::simulate_study(request));
}

}  // namespace

void add_studies(py::module_& module) {
  py::class_<Study>(module, "Study", "An unblinded study, opened for reading.")
      .def("report", &Study::report, py::call_guard<py::gil_scoped_release>(),
           "The text that `touchtrial report --json` prints.")
      .def("tables", &tables_of, "Columns by table and name, as in `export --format csv`.")
      .def("trace", &trace_of, py::arg("session"), py::arg("trial"),
           "The rate in Hz, and (N, 6) positions in mm and forces in N.")
      .def_property_readonly("simulated",
                             [](const Study& study) { return study.outcomes().simulated; })
      .def_property_readonly("name", [](const Study& study) { return study.outcomes().study; });
  module.def("read", &read, py::arg("database"), py::arg("key"), py::arg("passphrase"),
             "Opens an unblinded study.");
  module.def("simulate", &simulate, py::arg("study"), py::arg("database"), py::arg("participants"),
             py::arg("seed"), py::arg("subject"), py::arg("on"), py::arg("jobs"),
             py::arg("first_participant"), py::arg("keep_blind"),
             "The text that `touchtrial simulate --json` prints.");
}

}  // namespace touchtrial::python
