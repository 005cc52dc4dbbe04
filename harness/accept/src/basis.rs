//! What the tests rest on: rules of standards, and from where they are known here.

/// A rule of a standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Basis {
    /// The standard.
    pub standard: &'static str,
    /// What it says.
    pub rule: &'static str,
    /// Who else says so. Nothing here was held against the text of the standard itself.
    pub by: &'static str,
}

/// Of tests by lengths.
pub const OF_LENGTHS: [Basis; 5] = [
    Basis {
        standard: "VDI/VDE 2634 part 1",
        rule: "the error is the measured less the calibrated length, each against the limit A + K L, at most B",
        by: "Luhmann et al., Close-Range Photogrammetry and 3D Imaging",
    },
    Basis {
        standard: "VDI/VDE 2634 part 1",
        rule: "seven measurement lines at least, five lengths on each",
        by: "Luhmann et al., Close-Range Photogrammetry and 3D Imaging",
    },
    Basis {
        standard: "VDI/VDE 2634 part 1",
        rule: "the longest length is at least two thirds of the diagonal of the measuring volume",
        by: "a thesis at the University of Hannover (yumpu.com/de/document/view/3053814, page 12)",
    },
    Basis {
        standard: "ISO 14253-1:2017",
        rule: "without another agreement conformity, or the contrary, is shown at 95 % probability: a guard band of 1.65 standard uncertainties",
        by: "ILAC-G8:09/2019, table 1 (0.83 U with k = 2)",
    },
    Basis {
        standard: "JCGM 106:2012",
        rule: "the probability within two limits is the integral of a normal density between them",
        by: "Sandia's uncertainty calculator (sandialabs/suncal), whose tests hold the same numbers",
    },
];

/// Of tests by check points.
pub const OF_POINTS: [Basis; 3] = [
    Basis {
        standard: "ASPRS Positional Accuracy Standards, edition 2 (2023)",
        rule: "accuracies are root mean squares: horizontal of X and Y, vertical of Z, 3D of both, the survey's own added in squares",
        by: "Abdullah 2023, PE&RS 89(10), 581-588",
    },
    Basis {
        standard: "ASPRS Positional Accuracy Standards, edition 2 (2023)",
        rule: "30 check points at least",
        by: "GPS World, 6 December 2023",
    },
    Basis {
        standard: "ASPRS Positional Accuracy Standards, edition 2 (2023)",
        rule: "a mean error beyond 25 % of the class asks for its cause",
        by: "Abdullah 2014, PE&RS 80(5), 397, of edition 1",
    },
];
