#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

// Drops of blood that are thrown at a wall or a floor, and the stains that they leave. Lengths in mm, speeds in m/s.
namespace likeness::blood {

enum class Speed { kLow, kMedium, kHigh };
enum class Part { kCore, kBorder, kOuterBorder, kMist, kDrips };

struct SpeedRow {
  Speed speed;
  std::string_view name, cause;
  std::array<double, 2> velocity;  // of drops as they leave [m/s]
  std::array<double, 2> stain;     // width a drop would leave at once, head on [mm]; logarithms are spread evenly
  double mist;                     // share of drops that are mist
  double cone_deg;                 // half the angle within which 86 % fly (2 sigma)
  int drops;                       // by default
};
// Classes of the field: T. Bevel and R. Gardner, "Bloodstain Pattern Analysis", 3rd edition, CRC Press 2008 (low: gravity,
// stains of 4 mm and more; medium: blows, 1 to 4 mm; high: shots, below 1 mm). Velocities are theirs (5 and 25 feet a
// second, and 100 and more).
inline constexpr std::array kSpeeds{
    SpeedRow{Speed::kLow, "low", "gravity: a wound that drips", {0.5, 1.5}, {4.5, 12}, 0, 6, 24},
    SpeedRow{Speed::kMedium, "medium", "a blow", {1.5, 7.5}, {1, 4}, 0.15, 18, 400},
    SpeedRow{Speed::kHigh, "high", "a shot", {30, 100}, {0.1, 1}, 0.6, 30, 20000},
};
inline constexpr std::array<double, 2> kMistDiameter{0.03, 0.12};  // of drops [mm]

struct PartRow {
  Part part;
  std::string_view name, text;
};
inline constexpr std::array kParts{
    PartRow{Part::kCore, "core", "stains within half the cone"},
    PartRow{Part::kBorder, "border", "stains within the cone"},
    PartRow{Part::kOuterBorder, "outer_border", "stains beyond it"},
    PartRow{Part::kMist, "mist", "drops of 0.03 to 0.12 mm that fly far enough"},
    PartRow{Part::kDrips, "drips", "what runs down a wall from stains that hold too much"},
};

// One row of docs/blood.md: what is taken from whom.
struct Relation {
  std::string_view what, formula, source;
};
inline constexpr std::array kRelations{
    Relation{"impact angle", "sin(alpha) = width / length", "Balthazard et al. 1939; Bevel and Gardner 2008"},
    Relation{"speed class", "low: stains of 4 mm and more; medium: 1 to 4 mm; high: below 1 mm",
             "Bevel and Gardner 2008"},
    Relation{"spread", "width = max(1, Re^(1/4) / 2) diameter",
             "Hulse-Smith, Mehdizadeh and Chandra, J. Forensic Sci. 50(1), 2005"},
    Relation{"spines", "N = 1.14 We^(1/2)",
             "Mehdizadeh, Chandra and Mostaghimi 2004, as used by Hulse-Smith et al. 2005"},
    Relation{"drag", "Cd = 24 / Re (1 + 0.15 Re^0.687), 0.44 above Re 1000",
             "Schiller and Naumann 1933; for drops of blood: Attinger et al., Forensic Sci. Int. 231, 2013"},
    Relation{"distance", "a drop arrives if drag has left it a tenth of its speed (ours); small ones are stopped first",
             "Attinger et al. 2013; shots: Attinger et al., Data in Brief 22, 2019"},
};

// Blood at body temperature, and air: kg/m^3, Pa s, N/m.
inline constexpr double kBloodDensity = 1060, kBloodViscosity = 4.8e-3, kBloodTension = 0.06, kAirDensity = 1.2,
                        kAirViscosity = 1.8e-5;

inline constexpr double kTrackThickness = 0.1;  // of what has run down a wall [mm]

// Speed after `distance` metres of a drop of `diameter` mm that began with `velocity`: straight on, by drag alone. 0 if it
// comes to rest before.
double speed_after(double velocity, double diameter, double distance);
// Speed at which drag holds its weight.
double falling_speed(double diameter);
// Width of its stain over its diameter, and how many spines its rim has, by the speed across the surface's normal.
double spread(double velocity, double diameter);
// The diameter whose stain has that width.
double diameter_of_stain(double width, double velocity);
int spines(double velocity, double diameter);

struct SpatterOptions {
  Speed speed = Speed::kMedium;
  double distance = 0.5;  // from the source to the receiver along the axis [m], 0 to 20
  double angle_deg = 90;  // of the axis to the receiver, 5 to 90; below 90 stains point upwards
  bool is_wall = true;    // drips run down; a floor has none
  int drops = -1;         // thrown; below 0: as the class has them
  std::uint64_t seed = 1;
};

struct Drop {
  std::array<double, 2> at{};         // middle of the stain: right, up [mm]; 0: where the axis meets the receiver
  double diameter = 0, velocity = 0;  // in flight [mm]; as it arrives [m/s]
  double width = 0, length = 0;       // of the stain [mm]
  double turn = 0;                    // of the length against the right, counter-clockwise [rad]
  double angle_deg = 90;              // of impact
  int spines = 0;
  Part part = Part::kCore;
  double run = 0, run_width = 0;  // the track of what runs down [mm]; the stain stays where it is
};

struct Spatter {
  int thrown = 0, thrown_mist = 0;
  std::vector<Drop> drops;  // that arrived
};

// Each drop's size, speed and direction depend on the seed and its number alone, so that the drops that arrive at some
// distance are among those that arrive nearer.
Spatter spatter_of(const SpatterOptions& options);

}  // namespace likeness::blood
