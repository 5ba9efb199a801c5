#include "bench/docs/publish.hpp"

#include "bench/docs/page_section.hpp"
#include "bench/figures/figures.hpp"
#include "bench/results_json.hpp"
#include "core/bytes.hpp"
#include "core/files.hpp"

#include <string>

#include <fmt/format.h>

namespace touchtrial::bench {

void publish(const Machine& machine, const Results& results, const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / "README.md";
  const Bytes bytes = read_file(page);
  const std::string text(bytes.begin(), bytes.end());
  const std::string section =
      fmt::format("{}; {}, OpenCV {}; {}.\n\n{}", machine.processor, machine.compiler,
                  machine.opencv, machine.date, goals_table(results.goals));
  const std::string updated = with_section(text, "goals", section);
  draw_figures(results.rows, results.courses, Format::svg, folder);
  replace_file(folder / "results.json", results_json(machine, results.goals, results.rows));
  replace_file(page, updated);
}

}  // namespace touchtrial::bench
