#include "analysis/json_figures.hpp"
#include "analysis/report/report_sections.hpp"

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json rows_json(const Plane<double>& figures) {
  Json rows = Json::array();
  for (int i = 0; i < figures.height(); ++i) {
    Json row = Json::array();
    for (const double figure : figures.row(i)) row.push_back(figure_json(figure));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

nlohmann::ordered_json choice_object(const ChoiceModel& model) {
  Json bias = Json::array();
  for (const double figure : model.bias) bias.push_back(figure_json(figure));
  Json object{{"similarity", rows_json(model.similarity)},
              {"bias", std::move(bias)},
              {"group", model.group},
              {"expected", rows_json(model.expected)},
              {"g_squared", figure_json(model.g_squared)},
              {"degrees_of_freedom", model.degrees_of_freedom},
              {"p", figure_json(model.p)},
              {"converged", model.converged}};
  put_method(object,
             "similarity choice model, maximum likelihood; biases sum to 1 within a group of "
             "classes that answers lead between both ways; p of G squared under chi-square against "
             "the saturated model",
             {"luce1963", "townsend1982"});
  return object;
}

}  // namespace touchtrial::analysis
