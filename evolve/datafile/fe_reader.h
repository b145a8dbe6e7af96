/// Internal to the datafile reader: one pass over the tokens.
#pragma once

#include <set>
#include <unordered_map>

#include "evolve/datafile/fe_file.h"

namespace meniscus::datafile {

class FeReader {
 public:
  FeReader(std::string_view text, const std::string& name);
  FeFile read();

 private:
  // Which names a formula may use besides parameters.
  enum class Sees { Nothing, Place, Parameter };

  // fe_reader.cpp: declarations in front of the elements.
  void top_section();
  void declaration();
  bool ignored(const std::string& keyword);
  void refuse(const FeToken& keyword);
  void parameter();
  void attribute();
  void boundary();
  void constraint();
  void integrals(FeIntegrals& integrals);
  void integral_order(const FePlace& place);
  std::string declared_name(const char* what);

  // fe_reader_quantities.cpp
  void quantity(const FePlace& place);
  void method_instance(const FePlace& place);
  FeMethod method(const FePlace& place);
  void method_of(FeQuantity& quantity, bool global);
  void integrand(FeMethod& method);

  // fe_reader_elements.cpp
  void vertices();
  void edges();
  void faces();
  void bodies();
  void vertex();
  void edge();
  void face();
  void body();
  void check_loop(const FeFace& face);
  bool body_attribute(FeBody& body);
  bool mark(FeElement element, FeMarks& marks);
  void on_constraints(FeMarks& marks);
  void on_boundary(FeMarks& marks);
  bool own_attribute(FeElement element, FeMarks& marks);
  bool own_quantity(FeElement element, FeMarks& marks);
  int element_number(const char* what);
  int reference(const std::unordered_map<int, int>& ids, const char* what);
  [[noreturn]] void unknown_mark(const char* element);

  // Shared.
  void skip_separators();
  bool starts_element();
  bool on_line();  // more of the element at hand
  bool signed_integer_ahead();
  int integer(const char* what);  // with its sign
  std::string string(const char* what);
  void accept(std::string_view symbol);
  // `owner`: the element whose attributes the formula sees as well.
  FeExpression formula(Sees sees, std::optional<FeElement> owner = {});
  FeField field(const char* letter, Sees sees,
                std::optional<FeElement> owner = {});
  FeExpression constant() { return formula(Sees::Nothing); }
  void check_name(const FeNode& node, Sees sees,
                  std::optional<FeElement> owner);
  int attribute_index(FeElement element, const std::string& name) const;

  FeLexer lexer_;
  FeFile file_;
  std::set<std::string> parameters_;
  std::unordered_map<std::string, int> boundary_;
  std::unordered_map<std::string, int> constraint_;
  std::unordered_map<std::string, int> quantity_;
  std::unordered_map<std::string, FeMethod> methods_;
  std::unordered_map<int, int> vertex_;
  std::unordered_map<int, int> edge_;
  std::unordered_map<int, int> face_;
  std::set<int> body_;
};

}  // namespace meniscus::datafile
