/// Internal to energy and film_products: the elements of a term one by one.
#pragma once

#include <algorithm>

#include "core/parallel_for.h"
#include "evolve/energy/energy.h"
#include "evolve/energy/facet_terms.h"

namespace meniscus::energy {

/// Those of a term's field; none of a term without.
inline Numbers numbers_of(const FilmTerm& term,
                          const std::vector<VectorX>& numbers) {
  const auto q = static_cast<std::size_t>(term.field());
  if (!term.has_numbers() || term.field() < 0 || q >= numbers.size()) {
    return {};
  }
  return {numbers[q].data(), static_cast<std::size_t>(numbers[q].size())};
}

template <class Wanted, class Each>
void FilmEnergy::over_term(const FilmTerm& term, const Points& points,
                           JetOrder order, Numbers numbers,
                           const Wanted& wanted, const Each& each) const {
  const auto jet_of_element = [&](const FilmTerm::Element& e) {
    return term.jet(e, corners_of(points, facets_[e.facet]), order, numbers);
  };
  if (!term.is_costly()) {
    for (const FilmTerm::Element& e : term.elements()) {
      if (wanted(e)) {
        each(e, jet_of_element(e));
      }
    }
    return;
  }
  // Jets in threads, added in their order.
  constexpr std::size_t kChunk = 1024;
  const std::vector<FilmTerm::Element>& all = term.elements();
  std::vector<FacetJet> jets(std::min(kChunk, all.size()));
  for (std::size_t first = 0; first < all.size(); first += kChunk) {
    const auto count =
        static_cast<std::ptrdiff_t>(std::min(kChunk, all.size() - first));
    parallel_for(count, [&](std::ptrdiff_t k) {
      if (wanted(all[first + k])) {
        jets[k] = jet_of_element(all[first + k]);
      }
    });
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      if (wanted(all[first + k])) {
        each(all[first + k], jets[k]);
      }
    }
  }
}

template <class Each>
void FilmEnergy::over_term(const FilmTerm& term, const Points& points,
                           JetOrder order, Numbers numbers,
                           const Each& each) const {
  over_term(
      term, points, order, numbers,
      [](const FilmTerm::Element& /*e*/) { return true; }, each);
}

}  // namespace meniscus::energy
