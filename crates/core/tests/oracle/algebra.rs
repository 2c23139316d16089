//! Vectors as arrays, and linear equations by elimination.

pub type Vector = [f64; 3];
pub type Matrix = [Vector; 3];

/// The plane normal **n**.
pub const NORMAL: Vector = [0.0, 0.0, 1.0];

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn times(factor: f64, a: Vector) -> Vector {
    a.map(|x| factor * x)
}

pub fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn minus(a: Vector, b: Vector) -> Vector {
    plus(a, times(-1.0, b))
}

pub fn norm(a: Vector) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

pub fn apply(m: &Matrix, a: Vector) -> Vector {
    [dot(m[0], a), dot(m[1], a), dot(m[2], a)]
}

/// x with Ax = b, by elimination with row pivots.
pub fn solve(a: &Matrix, b: Vector) -> Vector {
    let mut rows: [[f64; 4]; 3] = [0, 1, 2].map(|i| [a[i][0], a[i][1], a[i][2], b[i]]);
    for i in 0..3 {
        let pivot = (i..3)
            .max_by(|&j, &k| rows[j][i].abs().total_cmp(&rows[k][i].abs()))
            .unwrap();
        rows.swap(i, pivot);
        let pivot = rows[i];
        for row in &mut rows[i + 1..] {
            let factor = row[i] / pivot[i];
            for (x, y) in row.iter_mut().zip(pivot) {
                *x -= factor * y;
            }
        }
    }
    let mut x = [0.0; 3];
    for i in (0..3).rev() {
        let known: f64 = (i + 1..3).map(|k| rows[i][k] * x[k]).sum();
        x[i] = (rows[i][3] - known) / rows[i][i];
    }
    x
}
