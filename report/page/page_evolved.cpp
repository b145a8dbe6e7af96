#include "report/page/page_evolved.h"

#include <vector>

#include <nlohmann/json.hpp>

#include "report/page/packed_array.h"

namespace meniscus::page {

using Json = nlohmann::ordered_json;

void add_evolved(const Json& film, Json& page) {
  Json figures = film;
  for (const char* other :
       {"schema_version", "title", "status", "message", "units", "quantities",
        "seconds", "solids", "curves", "frames"}) {
    figures.erase(other);
  }
  page["result"] = {{"case", film.at("title")},
                    {"status", film.at("status")},
                    {"message", film.at("message")},
                    {"film", std::move(figures)},
                    {"seconds", {{"total", film.at("seconds")}}},
                    {"warnings", Json::array()}};
  if (film.contains("units")) {
    page["result"]["units"] = film["units"];
  }
  page["quantities"] = film.value("quantities", Json::object());
  page["captions"] = film.at("frames");
  page["curves"] = Json::array();
  for (const Json& curve : film.at("curves")) {
    page["curves"].push_back(
        {{"name", curve.at("name")},
         {"pieces", true},
         {"points", pack_reals(curve.at("ends").get<std::vector<double>>(), 3)},
         {"motion", Json::object()}});
  }
}

}  // namespace meniscus::page
