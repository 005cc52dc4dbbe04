//! The points of a board in images: `cargo run --release -p calibench-detect --example detect BOARD IMAGE...` prints `image,point,x,y`.

use std::time::Instant;

use calibench_model::Image;
use calibench_model::boards::Board;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let board: Board = arguments.next().ok_or("expected BOARD IMAGE...")?.parse()?;
    let layout = board.layout()?;
    for path in arguments {
        let read = image::open(&path)?.to_luma32f();
        let image = Image::new(read.width() as usize, read.height() as usize, read.into_raw());
        let start = Instant::now();
        let found = calibench_detect::detect(&image, &board);
        let spent = start.elapsed().as_secs_f64();
        match found {
            Ok(found) => {
                eprintln!("{path}: {} marks, {} points, {:?}, {spent:.5} s", found.markers, found.points.len(), found.doubts);
                for point in &found.points {
                    println!("{path},{},{:.3},{:.3}", layout.points[point.index].id, point.position.x, point.position.y);
                }
            }
            Err(error) => eprintln!("{path}: {}: {error}, {spent:.5} s", error.name()),
        }
    }
    Ok(())
}
