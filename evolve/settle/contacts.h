/// One-sided walls: which vertices lie on them.
#pragma once

#include "evolve/energy/energy.h"

namespace meniscus::settle {

/// Looks at every vertex with a one-sided wall: one that went through is put
/// on it and held, one that is held but pulled away by its film is let go
/// (active set; Nocedal, Wright, Numerical Optimization, 16.5). `pressure`:
/// one per functional. Returns how many changed: 0 when the film respects its
/// walls and no wall pulls.
int update_contacts(films::FilmComplex& complex,
                    const energy::FilmEnergy& energy, const VectorX& pressure);

/// True where some wall of the complex is one-sided.
bool has_contacts(const films::FilmComplex& complex);

}  // namespace meniscus::settle
