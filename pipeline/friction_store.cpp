#include "pipeline/friction_store.h"

#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace heddle::pipeline {

namespace {

using friction::About;
using friction::Effects;
using friction::HerseyTable;
using friction::Orientation;
using friction::SlipResistance;
using friction::ToolTemperatureShift;

// What a term holds beside the numbers of its description. A term with a new member of another kind fails to
// compile below until it is named here.
template <class Term>
constexpr std::size_t size_beside_numbers = 0;
template <>
constexpr std::size_t size_beside_numbers<SlipResistance> = sizeof(double);  // evolution
template <>
constexpr std::size_t size_beside_numbers<ToolTemperatureShift> = sizeof(double);  // form
template <>
constexpr std::size_t size_beside_numbers<Orientation> = sizeof(double);  // form
template <>
constexpr std::size_t size_beside_numbers<HerseyTable> = sizeof(HerseyTable);  // pairs and their curve

template <class Term>
constexpr bool is_kept_whole() {
  constexpr std::size_t numbers = About<Term>::fields.size() * sizeof(double);
  return std::is_empty_v<Term> || sizeof(Term) == numbers + size_beside_numbers<Term>;
}

template <class Term>
void write_term(Hdf5Writer& file, const std::string& group, const Term& term) {
  static_assert(is_kept_whole<Term>(), "a new member: keep it");
  for (const auto& field : About<Term>::fields) file.write(group + "/" + field.name, term.*(field.member));
  if constexpr (std::is_same_v<Term, SlipResistance>)
    file.write(group + "/evolution", static_cast<int>(term.evolution));
  if constexpr (std::is_same_v<Term, ToolTemperatureShift> || std::is_same_v<Term, Orientation>)
    file.write(group + "/form", static_cast<int>(term.form));
  if constexpr (std::is_same_v<Term, HerseyTable>) {
    file.write(group + "/hersey", term.hersey);
    file.write(group + "/coefficient", term.coefficient);
  }
}

template <class Term>
Term read_term(const Hdf5Reader& file, const std::string& group) {
  Term term;
  for (const auto& field : About<Term>::fields) term.*(field.member) = file.number(group + "/" + field.name);
  if constexpr (std::is_same_v<Term, SlipResistance>)
    term.evolution = static_cast<SlipResistance::Evolution>(file.integer(group + "/evolution"));
  if constexpr (std::is_same_v<Term, ToolTemperatureShift> || std::is_same_v<Term, Orientation>)
    term.form = static_cast<typename Term::Form>(file.integer(group + "/form"));
  if constexpr (std::is_same_v<Term, HerseyTable>)
    term = friction::hersey_table(file.doubles(group + "/hersey"), file.doubles(group + "/coefficient"));
  return term;
}

// One of several terms, by its name.
template <class... Terms>
void write_choice(Hdf5Writer& file, const std::string& group, const std::variant<Terms...>& choice) {
  std::visit(
      [&]<class Term>(const Term& term) {
        file.write(group + "/name", About<Term>::id);
        write_term(file, group, term);
      },
      choice);
}

template <class... Terms>
void read_choice(const Hdf5Reader& file, const std::string& group, std::variant<Terms...>& choice) {
  const std::string name = file.text(group + "/name");
  const auto take = [&]<class Term>(std::type_identity<Term>) {
    if (name != About<Term>::id) return false;
    choice = read_term<Term>(file, group);
    return true;
  };
  const bool known = (take(std::type_identity<Terms>{}) || ...);
  if (!known) throw Hdf5Error(group + " names nothing that is known: " + name);
}

// A struct of numbers by a list of its members; the size tells when one was added.
static_assert(sizeof(friction::PowerLawFilm) == 6 * sizeof(double));
template <class Film>
auto film_members(Film& f) {
  return std::tie(f.consistency, f.index, f.thickness, f.activation_energy, f.reference_temperature,
                  f.rate_floor);
}

static_assert(sizeof(friction::CalibrationBox) == 6 * sizeof(double));
template <class Box>
auto box_members(Box& b) {
  return std::tie(b.hersey_low, b.hersey_high, b.pressure_low, b.pressure_high, b.speed_low, b.speed_high);
}

template <class Tie>
void write_row(Hdf5Writer& file, const std::string& path, const Tie& tie) {
  file.write(path, std::apply([](const auto&... member) { return std::vector<double>{member...}; }, tie));
}

template <class Tie>
void read_row(const Hdf5Reader& file, const std::string& path, Tie tie) {
  const std::vector<double> values = file.doubles(path);
  if (values.size() != std::tuple_size_v<Tie>) throw Hdf5Error(path + " has the wrong length");
  std::size_t k = 0;
  std::apply([&](auto&... member) { ((member = values[k++]), ...); }, tie);
}

constexpr std::size_t size_of_visited_effects() {
  std::size_t size = 0;
  Effects effects;
  friction::for_each_effect(effects, [&](const auto& effect) { size += sizeof(effect); });
  return size;
}
static_assert(size_of_visited_effects() == sizeof(Effects), "an effect that for_each_effect leaves out");
static_assert(sizeof(friction::Model) == sizeof(friction::Law) + sizeof(friction::PowerLawFilm) +
                                             sizeof(Effects) + sizeof(friction::CalibrationBox) +
                                             sizeof(friction::Rheology) +
                                             sizeof(std::optional<friction::FilmConduction>),
              "a new part of the model: keep it");
static_assert(sizeof(friction::Rheology) == sizeof(friction::Flow) + sizeof(friction::TemperatureLaw));

}  // namespace

void write_model(Hdf5Writer& file, const friction::Model& model) {
  write_choice(file, "/law", model.law);
  write_row(file, "/film", film_members(model.film));
  write_row(file, "/box", box_members(model.box));
  write_choice(file, "/flow", model.rheology.flow);
  write_choice(file, "/temperature_law", model.rheology.temperature);
  if (model.conduction) {
    write_term(file, "/conduction", model.conduction->spec);
    file.write("/conduction/film_thickness", model.conduction->film_thickness);
  }
  friction::for_each_effect(model.effects, [&]<class E>(const std::optional<E>& effect) {
    if (effect) write_term(file, std::string("/effects/") + About<E>::id, *effect);
  });
}

friction::Model read_model(const Hdf5Reader& file) {
  friction::Model model;
  read_choice(file, "/law", model.law);
  read_row(file, "/film", film_members(model.film));
  read_row(file, "/box", box_members(model.box));
  read_choice(file, "/flow", model.rheology.flow);
  read_choice(file, "/temperature_law", model.rheology.temperature);
  if (file.has("/conduction/film_thickness"))  // its curves follow from its numbers
    model.conduction = friction::film_conduction(read_term<friction::FilmConductionSpec>(file, "/conduction"),
                                                 file.number("/conduction/film_thickness"));
  friction::for_each_effect(model.effects, [&]<class E>(std::optional<E>& effect) {
    const std::string group = std::string("/effects/") + About<E>::id;
    if (file.has(group + "/" + About<E>::fields[0].name)) effect = read_term<E>(file, group);
  });
  return model;
}

}  // namespace heddle::pipeline
