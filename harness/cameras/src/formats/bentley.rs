//! Bentley's BlocksExchange XML: each `<Photogroup>` is a camera.

use calibench_model::camera::{CameraModel, ImageSize, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::{NamedCamera, PixelPoint};
use roxmltree::Node;

use super::PLAIN;
use crate::brown::{Brown, middle, positive};
use crate::format::{Keeps, Model};
use crate::number::{finite, pixels, shortened, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "bentley",
    tool: "Bentley ContextCapture, iTwin Capture",
    versions: "BlocksExchange XML 2.1 and later, perspective photogroups",
    extension: "xml",
    words: "BlocksExchange Block Photogroups Photogroup ImageDimensions CameraModelType FocalLength FocalLengthPixels SensorSize PrincipalPoint Distortion K1 K2 K3 P1 P2",
    many: true,
    recognise: |source| xml::root_is(source.xml.as_ref(), "BlocksExchange"),
    read,
    write: Some(write),
    convention: Some(&tool_conventions::BENTLEY),
    models: |_| vec![Model { name: "Perspective", target: Target::OpenCv { coefficients: 5 } }],
    keeps: Keeps { name: true, ..PLAIN.keeps },
    ..PLAIN
};

const KNOWN: [&str; 13] = [
    "Name",
    "Description",
    "ImageDimensions",
    "CameraModelType",
    "CameraModelBand",
    "FocalLength",
    "SensorSize",
    "FocalLengthPixels",
    "CameraOrientation",
    "PrincipalPoint",
    "Distortion",
    "AspectRatio",
    "Skew",
];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let groups = document.root_element().descendants().filter(|node| node.has_tag_name("Photogroup"));
    groups.map(|group| camera(group, options)).collect()
}

fn camera(group: Node<'_, '_>, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let dimensions = xml::required(group, "ImageDimensions")?;
    let side = |name| {
        let node = xml::required(dimensions, name)?;
        pixels(xml::text(node)?).map_err(|error| xml::at(node, error))
    };
    let size = options.size_or(Some(ImageSize { width: side("Width")?, height: side("Height")? }));
    let size = size.map_err(|error| xml::at(dimensions, error))?;
    for (name, expected) in [("CameraModelType", "Perspective"), ("CameraOrientation", "XRightYDown")] {
        if let Some(node) = xml::child(group, name)? {
            let found = xml::text(node)?;
            if found != expected {
                return Err(xml::at(node, CameraFileError::new(format!("`{}` is not known here; expected {expected}", shortened(found)))));
            }
        }
    }
    let at = |error| xml::at(group, error);
    let (fx, per_mm) = focal(group, size)?;
    let aspect = positive("AspectRatio", xml::number(group, "AspectRatio")?.unwrap_or(1.0)).map_err(at)?;
    if let Some(skew) = xml::number(group, "Skew")?.filter(|&skew| skew != 0.0) {
        return Err(at(CameraFileError::new(format!("is {skew}; how it acts is not published; expected 0")).of("Skew")));
    }
    let PixelPoint { x: cx, y: cy } = principal_point(group, size, per_mm)?;
    let mut brown = Brown::plain(size, [fx, fx * aspect, cx, cy]);
    if let Some(distortion) = xml::child(group, "Distortion")? {
        let v = |name| Ok::<f64, CameraFileError>(xml::number(distortion, name)?.unwrap_or(0.0));
        (brown.k, brown.p1, brown.p2) = ([v("K1")?, v("K2")?, v("K3")?, 0.0], v("P1")?, v("P2")?);
    }
    let name = xml::child(group, "Name")?.map_or(Ok(""), xml::text)?;
    let mut notes: Vec<String> = Vec::new();
    if let Some(distortion) = xml::child(group, "Distortion")? {
        let names = xml::elements(distortion).map(|node| (node.tag_name().name(), node));
        notes.extend(options.of_lens(names, &["K1", "K2", "K3", "P1", "P2"], xml::at)?);
    }
    let photos = xml::elements(group).filter(|node| node.has_tag_name("Photo")).count();
    if photos > 0 {
        notes.push(format!("{photos} photos with their poses were left out"));
    }
    let others = xml::elements(group).map(|node| (node.tag_name().name(), node));
    notes.extend(options.of_file(others.filter(|(name, _)| !KNOWN.contains(name) && *name != "Photo"), xml::at)?);
    let pitch_um = per_mm.map(|per_mm| 1e3 / per_mm);
    Ok(NamedCamera { pitch_um, notes, ..NamedCamera::new(name, brown.camera()) })
}

/// The focal length, px, and px in a mm if the sensor's size is stated.
fn focal(group: Node<'_, '_>, size: ImageSize) -> Result<(f64, Option<f64>), CameraFileError> {
    let positive = |name: &str, value: f64| positive(name, value).map_err(|error| xml::at(group, error).of(name));
    let longer = f64::from(size.width.max(size.height));
    let sensor = xml::number(group, "SensorSize")?.map(|mm| positive("SensorSize", mm)).transpose()?;
    let per_mm = sensor.map(|mm| longer / mm);
    if let Some(px) = xml::number(group, "FocalLengthPixels")? {
        return Ok((positive("FocalLengthPixels", px)?, per_mm));
    }
    let mm = positive("FocalLength", xml::required_number(group, "FocalLength")?)?;
    let per_mm = per_mm.ok_or_else(|| xml::at(group, CameraFileError::new("has neither `FocalLengthPixels` nor `SensorSize`")))?;
    Ok((mm * per_mm, Some(per_mm)))
}

fn principal_point(group: Node<'_, '_>, size: ImageSize, per_mm: Option<f64>) -> Result<PixelPoint, CameraFileError> {
    let centre = middle(size);
    let Some(node) = xml::child(group, "PrincipalPoint")? else { return Ok(centre) };
    let value = |name| xml::child(node, name)?.map(|child| finite(xml::text(child)?).map_err(|error| xml::at(child, error))).transpose();
    match (value("x")?, value("y")?, value("xmm")?, value("ymm")?, per_mm) {
        (Some(x), Some(y), None, None, _) => Ok(PixelPoint::new(x, y)),
        (None, None, Some(x), Some(y), Some(per_mm)) => Ok(PixelPoint::new(centre.x + x * per_mm, centre.y + y * per_mm)),
        _ => Err(xml::at(node, CameraFileError::new("expected x and y, or xmm and ymm with `SensorSize`"))),
    }
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<BlocksExchange version=\"2.1\">\n  <Block>\n    <Name>calibench</Name>\n    <Photogroups>\n",
    );
    for named in cameras {
        let brown = Brown::of(&named.camera).filter(|brown| brown.skew == 0.0 && brown.k[3] == 0.0);
        let Brown { fx, fy, cx, cy, k, p1, p2, .. } = brown.ok_or_else(|| FORMAT.other_model("cameras of K1 to K3, P1, P2"))?;
        let ImageSize { width, height } = named.camera.size();
        out.push_str("      <Photogroup>\n");
        if !named.name.is_empty() {
            out.push_str(&format!("        <Name>{}</Name>\n", xml::escaped(&named.name)));
        }
        out.push_str(&format!("        <ImageDimensions><Width>{width}</Width><Height>{height}</Height></ImageDimensions>\n"));
        out.push_str("        <CameraModelType>Perspective</CameraModelType>\n");
        out.push_str(&format!("        <FocalLengthPixels>{}</FocalLengthPixels>\n", shortest(fx)));
        out.push_str("        <CameraOrientation>XRightYDown</CameraOrientation>\n");
        out.push_str(&format!(
            "        <PrincipalPoint><x>{}</x><y>{}</y></PrincipalPoint>\n        <Distortion>\n",
            shortest(cx),
            shortest(cy)
        ));
        for (name, value) in [("K1", k[0]), ("K2", k[1]), ("K3", k[2]), ("P1", p1), ("P2", p2)] {
            out.push_str(&format!("          <{name}>{}</{name}>\n", shortest(value)));
        }
        out.push_str(&format!("        </Distortion>\n        <AspectRatio>{}</AspectRatio>\n        <Skew>0</Skew>\n", shortest(fy / fx)));
        out.push_str("      </Photogroup>\n");
    }
    Ok(out + "    </Photogroups>\n  </Block>\n</BlocksExchange>\n")
}
