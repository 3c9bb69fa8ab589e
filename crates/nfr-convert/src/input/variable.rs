//! The axes and named instances of a variable font.

use read_fonts::FontRef;
use read_fonts::types::Tag;
use skrifa::MetadataProvider;

use super::face_names::name;
use crate::error::Error;

/// An axis of a variable font (OpenType 1.9, "fvar").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Its tag, as in `wght`.
    pub tag: Tag,
    /// The smallest value.
    pub min: f32,
    /// The value of the outlines as the font stores them.
    pub default: f32,
    /// The largest value.
    pub max: f32,
}

/// A value on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisValue {
    /// The tag of the axis.
    pub tag: Tag,
    /// The value, in the units of the axis.
    pub value: f32,
}

impl std::fmt::Display for AxisValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.tag.to_string().trim_end(), self.value)
    }
}

impl std::str::FromStr for AxisValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("{text:?} is no value of an axis; write a tag, = and a number, as in wght=600");
        let (tag, value) = text.split_once('=').ok_or_else(wrong)?;
        let tag = Tag::new_checked(tag.trim().as_bytes()).map_err(|_| wrong())?;
        let value: f32 = value.trim().parse().map_err(|_| wrong())?;
        if value.is_finite() { Ok(Self { tag, value }) } else { Err(wrong()) }
    }
}

/// A place of a variable font that has a name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedInstance {
    /// Its name, as in "Semibold".
    pub name: String,
    /// A value for each axis, in the font's order.
    pub values: Vec<f32>,
}

/// What a variable font varies in.
#[derive(Debug, Clone, PartialEq)]
pub struct Variations {
    /// The axes, in the font's order.
    pub axes: Vec<Axis>,
    /// The instances that have a name.
    pub instances: Vec<NamedInstance>,
}

impl Variations {
    /// The variations of a font; none if it is not variable.
    pub fn of(font: &FontRef<'_>) -> Option<Self> {
        let axes: Vec<Axis> = font
            .axes()
            .iter()
            .map(|axis| Axis {
                tag: axis.tag(),
                min: axis.min_value(),
                default: axis.default_value(),
                max: axis.max_value(),
            })
            .collect();
        let instances = font.named_instances().iter().filter_map(|instance| {
            let name = name(font, instance.subfamily_name_id())?;
            Some(NamedInstance { name, values: instance.user_coords().collect() })
        });
        let instances = instances.collect();
        (!axes.is_empty()).then_some(Self { axes, instances })
    }

    /// The place of the instance of this name. Capitals do not matter.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` if there is none, with the names that there are.
    pub fn named(&self, name: &str) -> Result<Vec<AxisValue>, Error> {
        let wanted = name.trim().to_lowercase();
        let found = self.instances.iter().find(|instance| instance.name.to_lowercase() == wanted);
        let Some(found) = found else {
            return Err(Error::InvalidParameter(format!(
                "the font has no instance {name:?}; it has {}",
                self.instances_text()
            )));
        };
        let values = self.axes.iter().zip(&found.values);
        Ok(values.map(|(axis, value)| AxisValue { tag: axis.tag, value: *value }).collect())
    }

    /// A value for each axis, in the font's order.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for an axis that the font does not have, one that is given twice or not at all, and for a value outside of
    /// the axis' range.
    pub fn complete(&self, values: &[AxisValue]) -> Result<Vec<AxisValue>, Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        for (place, given) in values.iter().enumerate() {
            let Some(axis) = self.axes.iter().find(|axis| axis.tag == given.tag) else {
                return wrong(format!("the font has no axis '{}'; it has {}", given.tag, self.axes_text()));
            };
            if !(axis.min..=axis.max).contains(&given.value) {
                return wrong(format!("{given} is outside of the axis' range, {}–{}", axis.min, axis.max));
            }
            if values[..place].iter().any(|other| other.tag == given.tag) {
                return wrong(format!("axis '{}' is given twice; give it once", given.tag));
            }
        }
        let value = |axis: &Axis| {
            values.iter().find(|given| given.tag == axis.tag).copied().ok_or_else(|| {
                let default = AxisValue { tag: axis.tag, value: axis.default };
                Error::InvalidParameter(format!(
                    "no value is given for axis '{}' ({}–{}); add --axis {default}, which is its default, or another value",
                    axis.tag, axis.min, axis.max
                ))
            })
        };
        self.axes.iter().map(value).collect()
    }

    /// The axes with their ranges and defaults, for people.
    pub fn axes_text(&self) -> String {
        let axis = |axis: &Axis| format!("{} {}–{} (default {})", axis.tag, axis.min, axis.max, axis.default);
        self.axes.iter().map(axis).collect::<Vec<_>>().join(", ")
    }

    /// The names of the instances, for people.
    pub fn instances_text(&self) -> String {
        if self.instances.is_empty() {
            return "no named instances".into();
        }
        self.instances.iter().map(|instance| format!("{:?}", instance.name)).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn variations() -> Variations {
        let axis = |tag, min, default, max| Axis { tag: Tag::new(tag), min, default, max };
        Variations {
            axes: vec![axis(b"wght", 100.0, 400.0, 900.0), axis(b"wdth", 75.0, 100.0, 100.0)],
            instances: vec![NamedInstance { name: "Bold".into(), values: vec![700.0, 100.0] }],
        }
    }

    fn values(list: &[&str]) -> Vec<AxisValue> {
        list.iter().map(|text| text.parse().unwrap()).collect()
    }

    fn refusal(list: &[&str]) -> String {
        variations().complete(&values(list)).unwrap_err().to_string()
    }

    #[test]
    fn values_come_in_the_fonts_order_of_axes() {
        let complete = variations().complete(&values(&["wdth=80.5", "wght=600"])).unwrap();
        assert_eq!(complete, values(&["wght=600", "wdth=80.5"]));
        assert_eq!(complete[1].to_string(), "wdth=80.5");
    }

    #[test]
    fn an_axis_that_is_not_given_is_named_with_its_default() {
        let text = refusal(&["wght=600"]);
        assert!(text.contains("'wdth'") && text.contains("--axis wdth=100"), "{text}");
    }

    #[test]
    fn what_the_font_does_not_have_is_refused_with_what_it_has() {
        assert!(refusal(&["opsz=12"]).contains("wght 100–900 (default 400), wdth"));
        assert!(refusal(&["wght=901", "wdth=100"]).contains("100–900"));
        assert!(refusal(&["wght=99.9", "wdth=100"]).contains("wght=99.9"));
        assert!(refusal(&["wght=500", "wght=600", "wdth=100"]).contains("twice"));
    }

    #[test]
    fn an_instance_is_found_by_its_name_whatever_its_capitals() {
        assert_eq!(variations().named("bold").unwrap(), values(&["wght=700", "wdth=100"]));
        let text = variations().named("Black").unwrap_err().to_string();
        assert!(text.contains("\"Black\"") && text.contains("it has \"Bold\""), "{text}");
    }

    #[test]
    fn a_value_is_a_tag_and_a_finite_number() {
        for wrong in ["wght", "wght=", "=5", "wght=bold", "wght=NaN", "wght=inf", "weight=5"] {
            assert!(wrong.parse::<AxisValue>().is_err(), "{wrong}");
        }
    }
}
