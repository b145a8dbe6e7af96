#include "pipeline/forward/figures_json.h"

#include <nlohmann/json.hpp>

#include "pipeline/files/place_json.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

nlohmann::ordered_json tet_json(const TetFigures& tet) {
  Json json = {{"nodes", tet.nodes},
               {"elements", tet.elements},
               {"min_dihedral_deg", tet.min_dihedral_deg},
               {"max_dihedral_deg", tet.max_dihedral_deg}};
  if (tet.facets > 0) {
    json["shell_facets"] = tet.facets;
  }
  return json;
}

nlohmann::ordered_json fea_json(const equations::ElasticReport& fea) {
  Json json = {{"element_order", 2},
               {"dofs", fea.dofs},
               {"solver", fea.solver},
               {"iterations", fea.iterations},
               {"residual", fea.residual},
               {"strain_energy", fea.strain_energy},
               {"reaction_imbalance", fea.reaction_imbalance}};
  if (!fea.process_memory.empty()) {
    json["process_memory"] = fea.process_memory;
  }
  return json;
}

nlohmann::ordered_json units_json(const UnitSystem& units) {
  return {{"system", units.name},
          {"length", units.length},
          {"force", units.force},
          {"pressure", units.pressure},
          {"mass", units.mass}};
}

nlohmann::ordered_json film_json(const settle::FilmReport& film) {
  Json bodies = Json::object();
  for (const settle::BodyState& body : film.bodies) {
    bodies[body.name] = {{"volume", body.volume}, {"pressure", body.pressure}};
  }
  return {{"vertices", film.vertices},
          {"facets", film.facets},
          {"energy", film.energy},
          {"area", film.area},
          {"residual", film.residual},
          {"residual_bound", film.residual_bound},
          {"min_eigenvalue", film.min_eigenvalue},
          {"index", film.index},
          {"index_at_least", film.index_at_least},
          {"smallest_neck", film.smallest_neck},
          {"neck_position",
           {film.neck_position.x(), film.neck_position.y(),
            film.neck_position.z()}},
          {"verdict", film.verdict},
          {"bodies", bodies}};
}

nlohmann::ordered_json popped_json(const settle::FilmReport& film) {
  Json json = Json::array();
  for (const settle::PulledFilm& popped : film.popped) {
    json.push_back({{"name", popped.name},
                    {"pulled_from", popped.pulled_from},
                    {"place", files::place_json(popped.place)},
                    {"area", popped.area}});
  }
  return json;
}

}  // namespace meniscus::forward
