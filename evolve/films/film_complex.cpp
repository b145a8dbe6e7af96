#include "evolve/films/film_complex.h"

namespace meniscus::films {

FilmComplex::FilmComplex() = default;
FilmComplex::~FilmComplex() = default;
FilmComplex::FilmComplex(const FilmComplex& other) = default;
FilmComplex::FilmComplex(FilmComplex&& other) noexcept = default;
FilmComplex& FilmComplex::operator=(const FilmComplex& other) = default;
FilmComplex& FilmComplex::operator=(FilmComplex&& other) noexcept = default;

}  // namespace meniscus::films
