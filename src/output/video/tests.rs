use std::fs::File;
use std::io::BufReader;

use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder as _, Rgba};

use super::*;

const SIZE: [u32; 2] = [64, 48];

/// A red square that moves over grey.
fn picture(index: u32) -> RgbaImage {
    RgbaImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let inside = (4 * index..4 * index + 10).contains(&x) && (10..20).contains(&y);
        Rgba(if inside {
            [200, 30, 30, 255]
        } else {
            [180, 180, 180, 255]
        })
    })
}

fn written(extension: &str, announced: u32, frames: u32) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("movie").with_extension(extension);
    let kind = KINDS.iter().find(|kind| kind.extension == extension).unwrap();
    let mut encoder = (kind.start)(&Start {
        path: &path,
        size: SIZE,
        rate: 10.0,
        frames: announced,
    })
    .unwrap();
    for index in 0..frames {
        encoder.picture(index, &picture(index)).unwrap();
    }
    encoder.finish().unwrap();
    (folder, path)
}

fn decoded(path: &Path) -> Vec<image::Frame> {
    let file = BufReader::new(File::open(path).unwrap());
    let frames = match path.extension().unwrap().to_str().unwrap() {
        "gif" => GifDecoder::new(file).unwrap().into_frames(),
        _ => PngDecoder::new(file).unwrap().apng().unwrap().into_frames(),
    };
    frames.collect_frames().unwrap()
}

#[test]
fn animations_show_every_picture() {
    for extension in ["gif", "png"] {
        let (_folder, path) = written(extension, 8, 8);
        let frames = decoded(&path);
        assert_eq!(frames.len(), 8, "{extension}");
        for (index, frame) in frames.iter().enumerate() {
            assert_eq!(frame.delay().numer_denom_ms(), (100, 1), "{extension}");
            let off = frame
                .buffer()
                .enumerate_pixels()
                .flat_map(|(x, y, pixel)| {
                    let wanted = *picture(index as u32).get_pixel(x, y);
                    pixel.0.into_iter().zip(wanted.0).map(|(a, b)| a.abs_diff(b))
                })
                .max();
            // A GIF has colors near the wanted ones.
            let most = if extension == "gif" { 8 } else { 0 };
            assert!(off <= Some(most), "{extension}, picture {index}: off by {off:?}");
        }
    }
}

#[test]
fn a_run_that_ends_early_has_a_whole_animation() {
    for extension in ["gif", "png"] {
        let (_folder, path) = written(extension, 100, 3);
        assert_eq!(decoded(&path).len(), 3, "{extension}");
    }
}

#[test]
fn large_and_long_runs_are_scaled_and_thinned_and_told() {
    let small = small::Small::new([1280, 720], 30.0, 61);
    assert_eq!(small.told().unwrap(), "every 2nd frame, scaled to 640×360");
    assert_eq!(small.pictures(), 31);
    let large = RgbaImage::new(1280, 720);
    assert_eq!(small.kept(2, &large).unwrap().dimensions(), (640, 360));
    assert!(small.kept(3, &large).is_none());
    assert!(small::Small::new([1280, 720], 30.0, 9000).pictures() <= 150);
    assert_eq!(small::Small::new(SIZE, 10.0, 8).told(), None);
}

#[test]
fn names_choose_the_kind() {
    assert_eq!(
        VideoOutput::new(Path::new("a.MP4")).unwrap().kind.extension,
        "mp4"
    );
    for wrong in ["movie", "movie.avi"] {
        let message = VideoOutput::new(Path::new(wrong)).unwrap_err().to_string();
        assert!(message.contains(wrong) && message.contains(".webm"), "{message}");
    }
}

#[test]
fn odd_rates_play_at_thirty() {
    assert_eq!([1.0, 24.0, 59.94, 1000.0].map(rate), [30.0, 24.0, 59.94, 30.0]);
}
