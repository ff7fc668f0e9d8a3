// The forms of a spectrum, and the wavelengths that are computed.
#include <cmath>

#include "engine/scene/members.h"

namespace cyanometer {
namespace {

class PerWavelengthList final : public Spelling<PerWavelength> {
 public:
  explicit PerWavelengthList(Spelled<double> value) : values_(list(std::move(value), 1, 64)) {}

  PerWavelength read(const Json& given, const At& at) const override {
    const std::size_t count = at.reading.scene.spectrum.wavelengths_nm.size();
    if (count == 0)
      refuse(at, given, "another form of a spectrum",
             "a list needs wavelengths to belong to, and spectrum.wavelengths_nm is \"auto\"");
    if (given.size() != count)
      refuse(at, given, "a list of " + std::to_string(count) + " numbers",
             "one for each of spectrum.wavelengths_nm");
    return {values_->read(given, at)};
  }
  Json write(const PerWavelength& value) const override { return values_->write(value.values); }
  Json schema(const Surroundings& around) const override {
    Json schema = values_->schema(around);
    schema["title"] = "One for each of spectrum.wavelengths_nm";
    return schema;
  }
  std::string words() const override {
    return "a list of numbers, one for each of spectrum.wavelengths_nm";
  }
  bool takes(const Json& given) const override { return given.is_array(); }

 private:
  Spelled<std::vector<double>> values_;
};

/// The shortest and the longest wavelength that is computed; "auto" stays within those of
/// colour.
std::array<double, 2> computed_nm(const Reading& reading) {
  const auto& chosen = reading.scene.spectrum.wavelengths_nm;
  if (chosen.empty()) return {360, 830};
  return {std::min(chosen.front(), chosen.back()), std::max(chosen.front(), chosen.back())};
}

/// A power law is monotonic: its ends are its extremes.
Rule<PowerLaw> within(double minimum, double maximum) {
  return Rule<PowerLaw>([=](const PowerLaw& law, const At& at) {
    for (const double nm : computed_nm(at.reading)) {
      const double value = law.value * std::pow(nm / law.at_nm, law.exponent);
      if (!(value >= minimum && value <= maximum))
        refuse(at, {{"value", law.value}, {"at_nm", law.at_nm}, {"exponent", law.exponent}},
               number(minimum, maximum)->words() + " at every wavelength that is computed",
               "it is " + in_words(value) + " at " + in_words(nm) + " nm");
    }
  });
}

ObjectOf<PowerLaw> power_law(double minimum, double maximum) {
  return object<PowerLaw>(Wrapped<PowerLaw>(
      "power_law",
      object<PowerLaw>(Member("value", &PowerLaw::value, number(minimum, maximum), "Value",
                              "The value at the wavelength at_nm.")
                           .required(),
                       Member("at_nm", &PowerLaw::at_nm, wavelength(), "At",
                              "The wavelength at which the value holds.")
                           .slider(380, 780, 1)
                           .required(),
                       Member("exponent", &PowerLaw::exponent, number(-10, 10), "Exponent",
                              "The value grows as the wavelength to this power.")
                           .slider(-5, 5, 0.1)
                           .required(),
                       within(minimum, maximum)),
      "Power law", "A power of the wavelength."));
}

ObjectOf<SampledSpectrum> sampled(double minimum, double maximum) {
  return object<SampledSpectrum>(
      Member("wavelengths_nm", &SampledSpectrum::wavelengths_nm,
             list(number(1, 1e5), 1, 4096, Order::ascending), "Wavelengths",
             "The wavelengths of the values; linear between them, constant beyond.")
          .required(),
      Member("values", &SampledSpectrum::values, list(number(minimum, maximum), 1, 4096),
             "Values", "One value for each of the wavelengths.")
          .required(),
      Rule<SampledSpectrum>([](const SampledSpectrum& spectrum, const At& at) {
        if (spectrum.values.size() != spectrum.wavelengths_nm.size())
          refuse(at / "values", spectrum.values,
                 "a list of " + std::to_string(spectrum.wavelengths_nm.size()) + " numbers",
                 "one for each of its wavelengths_nm");
      }));
}

}  // namespace

Spelled<double> wavelength() { return number(10, 5000); }

Spelled<Spectrum> spectrum(double minimum, double maximum) {
  return one_of<Spectrum, double, PerWavelength, PowerLaw, SampledSpectrum>(
      number(minimum, maximum), std::make_shared<PerWavelengthList>(number(minimum, maximum)),
      power_law(minimum, maximum), sampled(minimum, maximum));
}

ObjectOf<SpectrumChoice> spectrum_members() {
  return object<SpectrumChoice>(
      Member("wavelengths_nm", &SpectrumChoice::wavelengths_nm,
             keyword_or("auto", list(wavelength(), 1, 64, Order::monotonic)), "Wavelengths",
             "The wavelengths that are computed, or as many as colour needs."),
      Member("colour", &SpectrumChoice::colour,
             choice<Colour>({{"channels", Colour::channels}, {"cie", Colour::cie}}), "Colour",
             "Three wavelengths shown as red, green and blue, or the colour that an eye sees.")
          .otherwise("channels for exactly three wavelengths, else cie",
                     [](const SpectrumChoice& chosen, const Reading&) {
                       return chosen.wavelengths_nm.size() == 3 ? Colour::channels
                                                                : Colour::cie;
                     }),
      Rule<SpectrumChoice>([](const SpectrumChoice& chosen, const At& at) {
        if (chosen.colour == Colour::channels && chosen.wavelengths_nm.size() != 3)
          refuse(at / "colour", "channels", "\"cie\"",
                 "channels needs exactly three wavelengths_nm");
      }));
}

}  // namespace cyanometer
