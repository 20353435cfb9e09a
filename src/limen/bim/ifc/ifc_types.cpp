// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_types.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "limen/base/text.h"
#include "limen/files/text_numbers.h"
#include "limen/io/table/record_table.h"

namespace limen {
namespace {

/// Types of elements, each without its Ifc.
constexpr std::string_view kElementTypes =
    "Wall WallStandardCase WallElementedCase CurtainWall Slab SlabStandardCase SlabElementedCase "
    "Roof Column ColumnStandardCase Beam BeamStandardCase Member MemberStandardCase Stair "
    "StairFlight Ramp RampFlight Railing Covering Plate PlateStandardCase Window "
    "WindowStandardCase Door DoorStandardCase Footing Pile Chimney ShadingDevice "
    "BuildingElementProxy BuildingElementPart BuildingElementComponent ElementAssembly "
    "FurnishingElement Furniture SystemFurnitureElement TransportElement CivilElement "
    "GeographicElement ProjectionElement DiscreteAccessory MechanicalFastener Fastener "
    "ReinforcingBar ReinforcingMesh Tendon TendonAnchor VibrationIsolator DistributionElement "
    "DistributionFlowElement DistributionControlElement DistributionChamberElement FlowTerminal "
    "FlowSegment FlowFitting FlowController FlowMovingDevice FlowStorageDevice "
    "FlowTreatmentDevice EnergyConversionDevice SanitaryTerminal LightFixture Lamp Outlet "
    "SwitchingDevice ElectricAppliance ElectricDistributionBoard SpaceHeater Boiler Tank Pump "
    "Fan Valve DuctSegment DuctFitting PipeSegment PipeFitting CableCarrierSegment "
    "CableCarrierFitting CableSegment AirTerminal AirTerminalBox WasteTerminal "
    "FireSuppressionTerminal StackTerminal Sensor Alarm Controller Actuator "
    "CommunicationsAppliance AudioVisualAppliance "
    // Of IFC4X3:
    "BuiltElement Course Kerb Pavement Rail TrackElement Bearing DeepFoundation CaissonFoundation "
    "EarthworksElement EarthworksFill ReinforcedSoil Sign Signal ImpactProtectionDevice TendonConduit "
    "ConveyorSegment LiquidTerminal ElectricFlowTreatmentDevice MobileTelecommunicationsAppliance "
    "DistributionBoard MooringDevice NavigationElement TransportationDevice Vehicle ";

}  // namespace

BimKind kind_of_ifc_type(const std::string& type, const std::string& predefined) {
  static constexpr std::array<std::pair<std::string_view, BimKind>, 34> kKinds{{
      {"ifcwallelement", BimKind::wall},
      {"ifcwall", BimKind::wall},
      {"ifccurtainwall", BimKind::wall},
      {"ifcslab", BimKind::slab},
      {"ifcfooting", BimKind::slab},
      {"ifcroof", BimKind::roof},
      {"ifccolumn", BimKind::column},
      {"ifcpile", BimKind::column},
      {"ifcchimney", BimKind::column},
      {"ifcbeam", BimKind::beam},
      {"ifcmember", BimKind::beam},
      {"ifcstair", BimKind::stair},
      {"ifcramp", BimKind::stair},
      {"ifcrailing", BimKind::railing},
      {"ifccovering", BimKind::covering},
      {"ifcplate", BimKind::plate},
      {"ifcwindow", BimKind::window},
      {"ifcdoor", BimKind::door},
      {"ifcfurn", BimKind::furniture},
      {"ifcsystemfurniture", BimKind::furniture},
      {"ifcflow", BimKind::furniture},
      {"ifcdistribution", BimKind::furniture},
      {"ifcenergyconversion", BimKind::furniture},
      {"ifcsanitary", BimKind::furniture},
      {"ifclight", BimKind::furniture},
      {"ifclamp", BimKind::furniture},
      {"ifcspaceheater", BimKind::furniture},
      {"ifcelectric", BimKind::furniture},
      {"ifcoutlet", BimKind::furniture},
      {"ifcswitchingdevice", BimKind::furniture},
      {"ifcairterminal", BimKind::furniture},
      {"ifcwasteterminal", BimKind::furniture},
      {"ifcsite", BimKind::terrain},
      {"ifcgeographicelement", BimKind::terrain},
  }};
  const std::string name = lower_case(type);
  const auto found = std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& known) {
    return std::string_view(name).substr(0, known.first.size()) == known.first;
  });
  if (found == kKinds.end()) return BimKind::other;
  if (found->second == BimKind::slab && lower_case(predefined) == "roof") return BimKind::roof;
  return found->second;
}

std::string element_type_named(std::string_view upper) {
  static const std::map<std::string, std::string, std::less<>> kByUpper = [] {
    std::map<std::string, std::string, std::less<>> types;
    for (const std::string_view word : split_tokens(kElementTypes)) {
      const std::string type = "Ifc" + std::string(word);
      types.emplace(upper_case(type), type);
    }
    return types;
  }();
  const auto found = kByUpper.find(upper);
  return found == kByUpper.end() ? std::string{} : found->second;
}

}  // namespace limen
